# SPDX-License-Identifier: MIT
"""A simulated hand presses on a plate of grain and strokes it: force and way of the probe over time.

usage: stroke.py PICTURE [--quick]
"""
import os
import sys
import tempfile

import matplotlib.pyplot as plt
import numpy as np
import papilla


def plate():
    """60 mm a side, with uv; what it feels like is assigned by name."""
    V = np.array([[0, 0, 0], [60, 0, 0], [60, 60, 0], [0, 60, 0]], float)
    mesh = papilla.mesh(V, [[0, 1, 2], [0, 2, 3]], V[:, :2] / 20)
    return papilla.single_part_scene(papilla.Part(name="plate", mesh=mesh), "formula")


def main(picture, quick):
    rules = papilla.Materials(
        materials={
            "grain": {
                "name": "grain", "texture": "grain:leather", "recipe": "grain:leather", "size_mm": [20, 20],
                "stiffness": 900, "damping": 0.3, "static_friction": 0.4, "dynamic_friction": 0.3, "height": {"depth_mm": 0.2},
            }
        },
        assign=[{"material": "grain"}],
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "plate.glb")
        papilla.write_scene(papilla.bake_scene(plate(), rules).scene, path)
        felt = papilla.load_haptic_scene(path)
    surface = papilla.contact_surface(felt)
    largest = papilla.largest_material(felt)
    seconds = 0.6 if quick else 1.5
    hand = papilla.press_and_stroke(surface, largest.material, largest.centre, seconds=seconds, speed_m_per_s=0.05)
    rows = papilla.simulate(surface, hand, papilla.device_caps("touch"), ticks=int(1000 * seconds)).rows
    figure, (top, bottom) = plt.subplots(2, 1, figsize=(11, 6), sharex=True, constrained_layout=True)
    for k, name in enumerate("xyz"):
        top.plot(rows["t"], rows["force"][:, k], label=f"force along {name}", linewidth=0.8)
    top.plot(rows["t"], np.linalg.norm(rows["force"], axis=1), "k", label="its size", linewidth=0.8)
    top.set(ylabel="N")
    top.legend(fontsize=8, ncol=4, loc="upper left")
    for name in ("hand", "probe", "proxy"):
        bottom.plot(rows["t"], 1e3 * (rows[name] @ up_of(rows)), label=name, linewidth=0.8)
    bottom.set(xlabel="s", ylabel="mm above the plate")
    bottom.legend(fontsize=8)
    figure.savefig(picture, dpi=110)


def up_of(rows):
    """The direction in which the hand came down, upwards."""
    way = rows["hand"][0] - rows["hand"][np.argmax(rows["in_contact"])]
    return way / np.linalg.norm(way)


if __name__ == "__main__":
    main(sys.argv[1], "--quick" in sys.argv)
