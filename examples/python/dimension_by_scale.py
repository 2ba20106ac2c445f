# SPDX-License-Identifier: MIT
"""The fractal dimension of surfaces by scale: log-log curves whose slope is the dimension.

usage: dimension_by_scale.py PICTURE [--quick]
"""
import sys

import matplotlib.pyplot as plt
import numpy as np
import papilla


def main(picture, quick):
    size = 129 if quick else 513
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 5), constrained_layout=True)
    for hurst in (0.2, 0.5, 0.8):
        surface = papilla.to_grey_image(papilla.brownian_surface_exact(size=size, hurst=hurst, seed=3))
        readings = papilla.read_fractal_dimensions(surface)
        curve = readings.box.curve
        left.loglog(curve["scale"], curve["measure"], ".-", label=f"H = {hurst}: box dimension {readings.box.dimension:.2f}")
        # The local slope says at which scales the power law holds.
        local = np.diff(np.log(curve["measure"])) / np.diff(np.log(curve["scale"]))
        middle = np.sqrt(curve["scale"][1:] * curve["scale"][:-1])
        best = readings.best.estimate
        line = right.semilogx(middle, np.abs(local), ".-", label=f"H = {hurst}, best {best.dimension:.2f}" if best else f"H = {hurst}")
        right.axhline(3 - hurst, color=line[0].get_color(), linestyle=":")
    left.set(xlabel="side of the boxes", ylabel="boxes")
    right.set(xlabel="side of the boxes", ylabel="dimension at that scale; dotted: 3 − H")
    left.legend(fontsize=9)
    right.legend(fontsize=9)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(sys.argv[1], "--quick" in sys.argv)
