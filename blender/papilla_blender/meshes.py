# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's meshes as surfaces in millimetres, and texture coordinates and colours back onto them."""
import contextlib

import bmesh
import numpy as np

from . import distortion
from .engine import EngineError, Mesh

UV_UNITS = "papilla_mm_per_uv"  # custom property of a mesh: by name of a layer


def mesh_objects(objects):
    """The mesh objects among them, one for each mesh: what objects share is looked at once, as the first one stands."""
    found = {}
    for obj in objects:
        if obj.type == "MESH":
            found.setdefault(obj.data.name_full, obj)
    return list(found.values())


def read_array(collection, attribute, width, kind):
    values = np.empty(len(collection) * width, kind)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, width) if width > 1 else values


class Surface:
    """The triangles of an object, by which Blender draws and exports it, with the loops and faces that they are of."""

    def __init__(self, obj, scene):
        self.object = obj
        mesh = obj.data
        local = read_array(mesh.vertices, "co", 3, np.float32).astype(float)
        world = np.array(obj.matrix_world, float)
        self.positions = (local @ world[:3, :3].T + world[:3, 3]) * (1000 * scene.unit_settings.scale_length)
        self._mirrored = np.linalg.det(world[:3, :3]) < 0
        self._counts = (len(mesh.vertices), len(mesh.loops))
        self.read_triangles()

    def read_triangles(self):
        mesh = self.object.data
        if len(mesh.vertices):
            mesh.vertices[0].normal.copy()  # Blender cuts bent quads by normals once it has them, as exporters see it
        mesh.calc_loop_triangles()
        self.triangles = read_array(mesh.loop_triangles, "vertices", 3, np.int32)
        self.loops = read_array(mesh.loop_triangles, "loops", 3, np.int32)
        self.faces = read_array(mesh.loop_triangles, "polygon_index", 1, np.int32)
        if self._mirrored:  # such objects are turned inside out
            self.triangles, self.loops = self.triangles[:, ::-1].copy(), self.loops[:, ::-1].copy()

    def check_unchanged(self):
        """@throws EngineError when the object was deleted or edited since."""
        try:
            mesh = self.object.data
        except ReferenceError:
            raise EngineError("an object was deleted meanwhile: nothing is changed") from None
        if self._counts != (len(mesh.vertices), len(mesh.loops)) or self.object.mode != "OBJECT":
            raise EngineError(f"{self.object.name}: it was edited meanwhile: nothing is changed")

    def mesh(self, uv=None):
        return Mesh(self.object.name, self.positions, self.triangles, uv)

    def uv(self, layer_name):
        """The coordinates of a layer per corner of the triangles, (m, 3, 2), in millimetres where the unit is known."""
        layer = self.object.data.uv_layers.get(layer_name)
        if layer is None:
            raise EngineError(f"{self.object.name}: it has no uv layer '{layer_name}'")
        values = read_array(*_coordinates(layer), 2, np.float32).astype(float)
        return values[self.loops] * units_of(self.object.data).get(layer_name, 1.0)


def _coordinates(layer):
    """The collection and the attribute of a layer's coordinates: `uv` from 3.5 on, `data` before."""
    return (layer.uv, "vector") if hasattr(layer, "uv") else (layer.data, "uv")


def units_of(mesh):
    """Millimetres per unit of uv of the layers that unwrap() wrote."""
    units = mesh.get(UV_UNITS)
    return units.to_dict() if hasattr(units, "to_dict") else {}


def write_uv(surface, uv, layer_name, mm_per_uv):
    """Writes coordinates per corner of the triangles, in millimetres, into a layer that is made where there is none.
    Faces that a seam goes through are split along it. @return their number.
    """
    mesh = surface.object.data
    scaled = uv / mm_per_uv
    split = _faces_with_seams(surface, scaled)
    if len(split):
        scaled = _split_faces(surface, split, scaled)
    layer = mesh.uv_layers.get(layer_name) or mesh.uv_layers.new(name=layer_name, do_init=False)
    if layer is None:
        raise EngineError(f"{mesh.name}: Blender has no room for another uv layer")
    values = np.zeros((len(mesh.loops), 2), np.float32)
    values[surface.loops.ravel()] = scaled.reshape(-1, 2)
    collection, attribute = _coordinates(layer)
    collection.foreach_set(attribute, values.ravel())
    mesh.uv_layers.active = layer
    mesh[UV_UNITS] = {**units_of(mesh), layer.name: float(mm_per_uv)}
    mesh.update()
    return len(split)


def _faces_with_seams(surface, uv):
    """The faces whose triangles have different coordinates at one loop."""
    loops, values = surface.loops.ravel(), uv.reshape(-1, 2)
    one = np.zeros((len(surface.object.data.loops), 2))
    one[loops] = values
    differs = (one[loops] != values).any(axis=1).reshape(-1, 3).any(axis=1)
    return np.unique(surface.faces[differs])


def _split_faces(surface, split, uv):
    """Splits faces into the triangles that they are drawn by; layers and attributes stay. The surface's loops and faces
    are numbered anew. @return the coordinates in the new order of triangles.
    """
    mesh = surface.object.data
    by_corners = {}
    for triangle, corners in enumerate(surface.triangles.tolist()):
        by_corners.setdefault(_from_least(corners), []).append(triangle)
    edges = {}
    for triangle in np.flatnonzero(np.isin(surface.faces, split)):
        corners = surface.triangles[triangle].tolist()
        edges.setdefault(int(surface.faces[triangle]), []).extend(zip(corners, corners[1:] + corners[:1]))
    work = bmesh.new()
    work.from_mesh(mesh)
    work.faces.ensure_lookup_table()
    for number, face in [(number, work.faces[number]) for number in edges]:
        pieces = [face]
        for a, b in edges[number]:
            _split_along(pieces, a, b)
    work.to_mesh(mesh)
    work.free()
    old = surface.triangles
    surface.read_triangles()
    result = np.empty_like(uv)
    for triangle, corners in enumerate(surface.triangles.tolist()):
        known = by_corners.get(_from_least(corners))
        if not known:
            raise EngineError(f"{mesh.name}: a face can't be split along the seam; triangulate the mesh first")
        of_old = known.pop()
        turn = old[of_old].tolist().index(corners[0])
        result[triangle] = np.roll(uv[of_old], -turn, axis=0)
    return result


def _split_along(pieces, a, b):
    """Splits the piece that has both vertices, unless an edge joins them there already."""
    for piece in pieces:
        corners = {v.index: v for v in piece.verts}
        if a not in corners or b not in corners:
            continue
        if any({a, b} == {v.index for v in edge.verts} for edge in piece.edges):
            continue
        made = bmesh.utils.face_split(piece, corners[a], corners[b])
        if made and made[0]:
            pieces.append(made[0])
        return


def _from_least(corners):
    """The same turn of the corners whichever one comes first."""
    least = corners.index(min(corners))
    return tuple(corners[least:] + corners[:least])


@contextlib.contextmanager
def first_in(objects, layer_name):
    """Within, the layer of this name comes first in meshes that unwrap() gave it: glTF's TEXCOORD_0, on which grain lies."""
    places = [(o.data, o.data.uv_layers.find(layer_name)) for o in objects if layer_name in units_of(o.data)]
    moved = [(mesh, place) for mesh, place in places if place > 0]
    try:
        for mesh, place in moved:
            _exchange(mesh, place)
        yield
    finally:
        for mesh, place in moved:
            _exchange(mesh, place)


def _exchange(mesh, place):
    """Exchanges the first uv layer with another one, names and all."""
    first, other = mesh.uv_layers[0], mesh.uv_layers[place]
    names = first.name, other.name
    values = [read_array(*_coordinates(layer), 2, np.float32) for layer in (first, other)]
    for layer, of_other in ((first, values[1]), (other, values[0])):
        collection, attribute = _coordinates(layer)
        collection.foreach_set(attribute, of_other.ravel())
    first.name = names[1] + ".moved"
    mesh.uv_layers[place].name = names[0]
    mesh.uv_layers[0].name = names[1]
    rendered = [layer.active_render for layer in mesh.uv_layers]
    if rendered[0] or rendered[place]:
        mesh.uv_layers[place if rendered[0] else 0].active_render = True


def write_distortion(surface, values, wrong, measure, worst, name):
    """A colour attribute of the faces' distortion and, as `name`.value, an attribute with the numbers themselves.
    values: per face, NaN for those without a value; wrong: faces that are flipped or degenerate.
    """
    mesh = surface.object.data
    colours = distortion.colour_bytes(np.where(wrong, np.nan, values), measure, worst)
    rgba = np.ones((len(mesh.polygons), 4), np.float32)
    rgba[:, :3] = distortion.linear(colours)
    of_loops = np.repeat(np.arange(len(mesh.polygons)), read_array(mesh.polygons, "loop_total", 1, np.int32))
    attribute = _fresh(mesh.color_attributes, name, "FLOAT_COLOR", "CORNER")
    attribute.data.foreach_set("color", rgba[of_loops].ravel())
    numbers = _fresh(mesh.attributes, f"{name}.value", "FLOAT", "FACE")
    numbers.data.foreach_set("value", np.nan_to_num(values, nan=-1.0).astype(np.float32))
    # Found anew: adding an attribute may move the others.
    mesh.color_attributes.active_color = mesh.color_attributes[name]
    mesh.update()


def _fresh(collection, name, kind, domain):
    """The attribute of this name, made anew where it is of another kind."""
    found = collection.get(name)
    if found is not None and (found.data_type != kind or found.domain != domain):
        collection.remove(found)
        found = None
    made = found or collection.new(name, kind, domain)
    if made is None or made.name != name:
        raise EngineError(f"the attribute '{name}' can't be made: another one has this name")
    return made
