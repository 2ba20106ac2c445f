#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes docs/pictures/object-textures.png: object_textures.py PAPILLA FOLDER OUT.png

A panel with a decal over its edge, a grille, and a ball; beside it the same with the grille replaced by its picture.
"""
import json
import math
import subprocess
import sys
from pathlib import Path

FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"
papilla, folder, out = sys.argv[1], Path(sys.argv[2]), sys.argv[3]
folder.mkdir(parents=True, exist_ok=True)
lines, count, normals_count = ["mtllib scene.mtl"], 0, 0


def add(name, material, points, faces, centre=None):
    """A group of an OBJ, turned so that its front looks along -y; faces count from 0. Round ones have normals."""
    global count, normals_count
    lines.extend([f"o {name}", f"usemtl {material}"])
    lines.extend("v {:.6f} {:.6f} {:.6f}".format(240 - x, 100 - y, z) for x, y, z in points)
    if centre:
        lines.extend("vn {:.6f} {:.6f} {:.6f}".format(centre[0] - x, centre[1] - y, z - centre[2]) for x, y, z in points)
    corner = (lambda i: f"{i + 1 + count}//{i + 1 + normals_count}") if centre else (lambda i: str(i + 1 + count))
    lines.extend("f " + " ".join(corner(i) for i in face) for face in faces)
    count, normals_count = count + len(points), normals_count + (len(points) if centre else 0)


def extrude(name, material, profile, x0, x1):
    """A closed profile in y and z, counter-clockwise seen from +x, along x."""
    n = len(profile)
    points = [(x, y, z) for x in (x0, x1) for y, z in profile]
    faces = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    faces += [tuple(range(n, 2 * n)), tuple(reversed(range(n)))]
    add(name, material, points, faces)


# The panel: 240 x 100 x 60 mm with a rounded front edge of 12 mm.
angles = [math.radians(5 * k) for k in range(19)]
profile = [(0, 0), (100, 0)] + [(88 + 12 * math.cos(a), 48 + 12 * math.sin(a)) for a in angles] + [(0, 60)]
extrude("panel", "panel", profile, 0, 240)
# The grille: 14 bars of 30 facets on the front, which looks along y.
for bar in range(14):
    x, points, faces, n = 150 + 5 * bar, [], [], 30
    for z in (8, 40):
        points += [(x + 1.6 * math.cos(2 * math.pi * k / n), 103 + 1.6 * math.sin(2 * math.pi * k / n), z) for k in range(n)]
    faces = [(k, (k + 1) % n, n + (k + 1) % n, n + k) for k in range(n)] + [tuple(range(n, 2 * n)), tuple(reversed(range(n)))]
    add(f"bar{bar}", "bars", points, faces)
# The ball: radius 22 on top.
rings, around = 40, 80
points = [(205 + 22 * math.sin(math.pi * i / rings) * math.cos(2 * math.pi * j / around),
           45 + 22 * math.sin(math.pi * i / rings) * math.sin(2 * math.pi * j / around),
           82 + 22 * math.cos(math.pi * i / rings)) for i in range(rings + 1) for j in range(around)]
add("ball", "ball", points, [(i * around + j, (i + 1) * around + j, (i + 1) * around + (j + 1) % around, i * around + (j + 1) % around)
                             for i in range(rings) for j in range(around)], (205, 45, 82))
(folder / "scene.obj").write_text("\n".join(lines) + "\n")
(folder / "scene.mtl").write_text("newmtl panel\nKd 0.25 0.27 0.3\nnewmtl bars\nKd 0.75 0.6 0.3\nnewmtl ball\nKd 0.9 0.9 0.9\n")

subprocess.run(["oiiotool", "--create", "1024x384", "4", f"--text:x=512:y=192:size=250:xalign=center:yalign=center:font={FONT}:color=0.95,0.75,0.2,1",
                "papilla", "-d", "uint8", "-o", str(folder / "logo.png")], check=True)
# A sky that is bright on one side, with a lamp.
subprocess.run(["oiiotool", "--pattern", "fill:topleft=0.1,0.2,0.5:topright=1.4,1.5,1.7:bottomleft=0.15,0.12,0.1:bottomright=0.3,0.25,0.2",
                "1024x512", "3", "--box:color=25,22,16:fill=1", "300,90,380,150", "--box:color=8,1,0.5:fill=1", "560,200,600,300",
                "-d", "float", "-o", str(folder / "sky.exr")], check=True)

rules = {
    "materials": {
        "panel": {"stiffness": 900, "dynamicFriction": 0.4, "roughness": 0.5},
        "brass": {"stiffness": 2000, "dynamicFriction": 0.2, "metallic": 1, "roughness": 0.3},
        "chrome": {"metallic": 1, "roughness": 0, "stiffness": 2000},
    },
    "assign": [{"part": "panel", "material": "panel"}, {"part": "bar*", "material": "brass"}, {"part": "ball", "material": "chrome"}],
    # From above and before, over the rounded edge.
    "decals": [{"picture": "logo.png", "part": "panel", "at": [165, 6, 54], "direction": [0, 1, -1], "up": [0, 1, 1],
                "size_mm": [110, 41], "depth_mm": 60, "height": {"depth_mm": 0.4}}],
}
replaced = dict(rules, replace=[{"name": "grille", "part": "bar*", "picture": {"render": True}, "at": [57.5, -3, 24], "direction": [0, 1, 0],
                                 "up": [0, 0, 1], "size_mm": [69, 33], "depth_mm": 8}])
shots = []
for name, content in (("whole", rules), ("replaced", replaced)):
    (folder / f"{name}.json").write_text(json.dumps(content, indent=1))
    report = folder / name
    subprocess.run([papilla, "bake", str(folder / "scene.obj"), "-m", str(folder / f"{name}.json"), "-o", str(folder / f"{name}.glb"), "--up", "z",
                    "--report", str(report), "--pictures", "--environment", str(folder / "sky.exr")], check=True)
    shots.append(str(report / "scene.png"))
subprocess.run(["oiiotool", "--pattern", "constant:color=1,1,1", "1600x500", "3", shots[0], "--ch", "R,G,B", "--resize", "800x500", "--swap",
                "--paste", "+0+0", shots[1], "--ch", "R,G,B", "--resize", "800x500", "--swap", "--paste", "+800+0", "-d", "uint8", "-o", out], check=True)
