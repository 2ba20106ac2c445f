# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as OBJ: text with all digits of a double, so that nothing is rounded on the way to the program and back."""
import numpy as np

from .base import EngineError, clean_name


def write_obj(path, meshes):
    """Writes an object per mesh, with uv where there are some."""
    lines, vertices, coordinates = [], 1, 1
    for mesh in meshes:
        lines.append(f"o {clean_name(mesh.name)}")
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.positions.tolist()]
        corners = (mesh.triangles + vertices).tolist()
        vertices += len(mesh.positions)
        if mesh.uv is None:
            lines += [f"f {a} {b} {c}" for a, b, c in corners]
            continue
        lines += [f"vt {u!r} {v!r}" for u, v in mesh.uv.reshape(-1, 2).tolist()]
        for (a, b, c), t in zip(corners, range(coordinates, coordinates + 3 * len(corners), 3)):
            lines.append(f"f {a}/{t} {b}/{t + 1} {c}/{t + 2}")
        coordinates += 3 * len(corners)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def read_obj_uv(path, triangle_counts):
    """The uv per corner of each object, (m, 3, 2), or None where one has none; in the order of the file.
    triangle_counts: what was written. @throws EngineError when the file has other triangles.
    """
    coordinates, faces = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("vt "):
                coordinates.append(line.split()[1:3])
            elif line.startswith("f "):
                faces.append([w.split("/")[1] if "/" in w else "0" for w in line.split()[1:]])
    if len(faces) != sum(triangle_counts) or any(len(f) != 3 for f in faces):
        raise EngineError(f"the program gave {len(faces)} triangles for {sum(triangle_counts)}")
    values = np.array(coordinates, float).reshape(-1, 2)
    indices = np.array([[int(i or 0) - 1 for i in f] for f in faces], int)
    result, begin = [], 0
    for count in triangle_counts:
        own = indices[begin:begin + count]
        result.append(values[own] if (own >= 0).all() else None)
        begin += count
    return result
