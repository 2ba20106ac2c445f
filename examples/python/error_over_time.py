# SPDX-License-Identifier: MIT
"""Error over run time: the trace of iterating methods on one surface, and the Pareto front of all.

usage: error_over_time.py PICTURE [--quick]
"""
import sys

import matplotlib.pyplot as plt
import numpy as np
import papilla
from distortion_of_methods import panel


def main(picture, quick):
    V, F = panel(24, 10) if quick else panel(90, 36)
    mesh = papilla.weld_equal(papilla.mesh(V, F)).mesh
    charts = papilla.given_charts(mesh, "keep")
    maps = {
        "best": papilla.flatten_best(mesh, charts),
        "maillot (gauss_newton)": papilla.flatten_maillot(mesh, charts).flattening,
        "maillot (gradient_descent)": papilla.flatten_maillot(mesh, charts, solver="gradient_descent", max_iterations=100).flattening,
        "levy": papilla.flatten_levy(mesh, charts).flattening,
        "lscm": papilla.flatten_lscm(mesh, charts),
        "arap": papilla.flatten_reference(mesh, charts, map="arap"),
    }  # fmt: skip
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 5), constrained_layout=True)
    for name, flattening in maps.items():
        trace = flattening.trace
        final = papilla.distortion(V, F, flattening.uv).symmetric_dirichlet.mean
        seconds = trace["seconds"][-1] if len(trace) else np.nan
        right.plot(1e3 * seconds, final, "o", label=name)
        if len(trace) > 1:
            left.plot(1e3 * trace["seconds"], trace["error"] / trace["error"][-1], ".-", label=name)
    left.set(xscale="log", yscale="log", xlabel="run time [ms]", ylabel="the method's own error / its last")
    right.set(xscale="log", xlabel="run time [ms]", ylabel="mean symmetric Dirichlet energy; 4 = isometry")
    left.legend(fontsize=8)
    right.legend(fontsize=8)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(sys.argv[1], "--quick" in sys.argv)
