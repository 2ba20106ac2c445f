# SPDX-License-Identifier: MIT
"""The same curved panel unwrapped by several methods, coloured by distortion side by side.

usage: distortion_of_methods.py PICTURE [--quick]
"""
import sys

import matplotlib.pyplot as plt
import numpy as np
import papilla

METHODS = ["planar", "tutte", "lscm", "arap", "maillot", "best"]


def panel(columns, rows):
    """A dashboard: bent in one direction, with a hood over the instruments. (n, 3) millimetres, (m, 3)."""
    u, v = np.meshgrid(np.linspace(-1, 1, columns + 1), np.linspace(0, 1, rows + 1))
    hood = 90 * np.exp(-(((u + 0.45) / 0.25) ** 2) - ((v - 0.4) / 0.3) ** 2)
    positions = np.column_stack([500 * u.ravel(), 300 * v.ravel(), (hood - 120 * v**2 - 60 * u**2).ravel()])
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    above = first + columns + 1
    triangles = np.vstack([np.column_stack([first, first + 1, above + 1]), np.column_stack([first, above + 1, above])])
    return positions, triangles


def main(picture, quick):
    V, F = panel(24, 10) if quick else panel(90, 36)
    figure, axes = plt.subplots(2, 3, figsize=(12, 7), constrained_layout=True)
    for axis, method in zip(axes.flat, METHODS):
        uv = papilla.parameterize(V, F, method=method, charts="keep").flattening.uv
        report = papilla.distortion(V, F, uv, normalize="none")
        corners = uv.values[uv.indices.ravel()]
        x, y = corners[:, 0], corners[:, 1]
        drawn = axis.tripcolor(
            x, y, np.arange(len(x)).reshape(-1, 3), report.per_triangle["symmetric_dirichlet"], vmin=4, vmax=5, cmap="viridis"
        )
        axis.set_title(f"{method}: mean {report.symmetric_dirichlet.mean:.3f}, flipped {report.flipped}", fontsize=10)
        axis.set_aspect("equal")
        axis.set_axis_off()
    figure.colorbar(drawn, ax=axes, label="symmetric Dirichlet energy; 4 = isometry", extend="max", shrink=0.8)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(sys.argv[1], "--quick" in sys.argv)
