#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures how much memory and time bakes of ever more parts take: bake_memory.py PAPILLA PAGE.md [MILLIONS ...]

The scenes are OBJ files of bent sheets, 2,450 triangles each and no two alike, side by side as in a stock of parts.
All get the same grain."""
import datetime
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CELLS = 35
TRIANGLES = 2 * CELLS * CELLS
MILLIONS = (0.3, 1.2, 4.9, 20)
BOUND_MB = 500
FOR_TIME, MOST_WALL = 4.9, 0.55


def write_scene(path, parts):
    across, corners = 50, CELLS + 1
    faces = [(x * corners + y, (x + 1) * corners + y, (x + 1) * corners + y + 1, x * corners + y + 1)
             for x in range(CELLS) for y in range(CELLS)]
    with open(path, "w", encoding="ascii") as out:
        for part in range(parts):
            left, low, first = part % across * 110, part // across * 110, part * corners * corners + 1
            waves = [5 * math.sin(0.1 * x + part) for x in range(corners)]
            lines = [f"o part{part}"]
            lines += [f"v {2 * x + left} {2 * y + low} {waves[x] * math.cos(0.07 * y):.4f}"
                      for x in range(corners) for y in range(corners)]
            for a, b, c, d in faces:
                lines.append(f"f {first + a} {first + b} {first + c}\nf {first + a} {first + c} {first + d}")
            out.write("\n".join(lines) + "\n")


def write_materials(path):
    grain = {"texture": "grain:leather", "size_mm": [40, 40], "stiffness": 900, "damping": 0.4, "staticFriction": 0.45,
             "dynamicFriction": 0.35, "height": {"method": "auto", "depth_mm": 0.25}}
    path.write_text(json.dumps({"materials": {"grain": grain}, "assign": [{"part": "*", "material": "grain"}]}))


def measure(papilla, folder, materials, parts):
    scene, baked = folder / "scene.obj", folder / "scene.glb"
    write_scene(scene, parts)
    scene.read_bytes()  # Not the disk is measured.
    start = time.monotonic()
    with subprocess.Popen([papilla, "bake", scene, "-m", materials, "-o", baked, "--cache", "none", "--quiet",
                           "--progress", "none"], stdout=subprocess.DEVNULL) as running:
        _, status, used = os.wait4(running.pid, 0)
        wall = time.monotonic() - start
        running.returncode = os.waitstatus_to_exitcode(status)
    if running.returncode:
        sys.exit(f"bake of {parts} parts ended with {running.returncode}")
    return {"parts": parts, "read_mb": scene.stat().st_size / 1e6, "written_mb": baked.stat().st_size / 1e6,
            "peak_mb": used.ru_maxrss * 1024 / 1e6, "wall_s": wall, "cpu_s": used.ru_utime + used.ru_stime}


def commit():
    said = subprocess.run(["git", "describe", "--always", "--dirty", "--abbrev=8", "--exclude=*"], text=True,
                          capture_output=True, check=False)
    return said.stdout.strip() or "unknown"


def page(rows):
    today = datetime.date.today().isoformat()
    lines = ["# Memory of a bake: what was measured", "",
             f"Written by `docs/make/bake_memory.py` on {today}, commit {commit()}.", "",
             f"OBJ files of bent sheets of {TRIANGLES:,} triangles, no two alike, all with one grain; `papilla bake` with "
             "two threads and without cache, peak resident memory of the process; the system's file cache has the scene before.",
             "", "## Targets", "",
             "| promise | measured | holds |", "|---|---|---|"]
    for row in rows:
        bound = BOUND_MB + row["written_mb"]
        lines.append(f"| {row['parts'] * TRIANGLES / 1e6:.1f} million triangles in {row['parts']:,} parts: at most "
                     f"{BOUND_MB} MB and what is written, {bound:.0f} MB | {row['peak_mb']:.0f} MB | "
                     f"{'yes' if row['peak_mb'] <= bound else 'no'} |")
    for row in rows:
        if row["parts"] == round(1e6 * FOR_TIME / TRIANGLES):
            share = row["wall_s"] / row["cpu_s"]
            lines.append(f"| {FOR_TIME} million triangles: wall time at most {MOST_WALL} of processor time on two processors | "
                         f"{share:.3f} | {'yes' if share <= MOST_WALL else 'no'} |")
    lines += ["", "## All", "",
              "| parts | triangles | read, MB | written, MB | peak, MB | bytes a triangle | wall, s | processor, s |",
              "|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for row in rows:
        triangles = row["parts"] * TRIANGLES
        lines.append(f"| {row['parts']:,} | {triangles:,} | {row['read_mb']:.1f} | {row['written_mb']:.1f} | "
                     f"{row['peak_mb']:.0f} | {1e6 * row['peak_mb'] / triangles:.0f} | {row['wall_s']:.1f} | "
                     f"{row['cpu_s']:.1f} |")
    lines += ["", "What waits for most of the time lies in a file without a name "
              "([how](../files.md#scenes-larger-than-memory)): the text of an OBJ while it is read, the parts (25 bytes a "
              "triangle as they are read, 45 with uv) and the trees in which the sides of open parts are looked for (22). In memory "
              "are the parts that are being unwrapped, the grains, and what is told of each part. `--pictures` keeps "
              "the surfaces with their distortion, 120 bytes a triangle more.", ""]
    return "\n".join(lines)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    papilla, out, *millions = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        materials = folder / "materials.json"
        write_materials(materials)
        rows = [measure(papilla, folder, materials, max(1, round(1e6 * m / TRIANGLES)))
                for m in (map(float, millions) if millions else MILLIONS)]
    Path(out).write_text(page(rows), encoding="utf-8")


main()
