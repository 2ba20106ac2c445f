# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours of distortion: closed forms, and the program's own colours on the same mesh."""
import struct
import unittest

import bpy
import numpy as np

from shapes import PROGRAM, addon, document, empty_scene, engines, place, run, settings, suzanne, use_engine

NAME = "papilla distortion"


def colours_of(obj):
    """Linear colours per face."""
    attribute = obj.data.color_attributes[NAME]
    values = np.empty(4 * len(attribute.data), np.float32)
    attribute.data.foreach_get("color", values)
    first = [face.loop_start for face in obj.data.polygons]
    return values.reshape(-1, 4)[first]


def values_of(obj):
    data = obj.data.attributes[NAME + ".value"].data
    values = np.empty(len(data), np.float32)
    data.foreach_get("value", values)
    return values


def bytes_of(linear):
    c = np.asarray(linear, float)[:, :3]
    return np.rint(255 * np.where(c <= 0.0031308, 12.92 * c, 1.055 * np.maximum(c, 1e-12) ** (1 / 2.4) - 0.055)).astype(int)


def colours_in_glb(path):
    """COLOR_0 of the first corner of each triangle, linear."""
    told = document(path)
    with open(path, "rb") as file:
        data = file.read()
    begin = 20 + struct.unpack("<I", data[12:16])[0] + 8
    kinds = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}

    def accessor(index, width):
        found = told["accessors"][index]
        view = told["bufferViews"][found["bufferView"]]
        kind = np.dtype(kinds[found["componentType"]])
        step = view.get("byteStride", width * kind.itemsize)
        at = begin + view.get("byteOffset", 0) + found.get("byteOffset", 0)
        rows = [np.frombuffer(data, kind, width, at + i * step) for i in range(found["count"])]
        scale = 1 if kind.kind == "f" or width == 1 else np.iinfo(kind).max
        return np.array(rows) / scale if width > 1 else np.array(rows).ravel()

    primitive = told["meshes"][0]["primitives"][0]
    width = 4 if told["accessors"][primitive["attributes"]["COLOR_0"]]["type"] == "VEC4" else 3
    return accessor(primitive["attributes"]["COLOR_0"], width)[accessor(primitive["indices"], 1).reshape(-1, 3)[:, 0]]


class DistortionTest(unittest.TestCase):
    def setUp(self):
        empty_scene()
        use_engine("PROGRAM")
        settings().layer, settings().normalize, settings().measure = "UVMap", "none", "SYMMETRIC_DIRICHLET"

    def stretched_plane(self, u, v):
        """A plane of 100 mm with u and v mm of uv per mm."""
        bpy.ops.mesh.primitive_plane_add(size=0.1)
        obj = bpy.context.object
        for corner in obj.data.uv_layers["UVMap"].data:
            corner.uv = (corner.uv[0] * 100 * u, corner.uv[1] * 100 * v)
        return obj

    def test_values_are_the_closed_forms(self):
        for engine in engines():
            for u, v in ((1, 1), (2, 1), (1.25, 0.8), (0.5, 3)):
                with self.subTest(f"{engine} {u} {v}"):
                    empty_scene()
                    use_engine(engine)
                    settings().layer, settings().normalize = "UVMap", "none"
                    obj = self.stretched_plane(u, v)
                    settings().measure = "SYMMETRIC_DIRICHLET"
                    bpy.ops.papilla.measure()
                    self.assertAlmostEqual(values_of(obj)[0], u * u + v * v + u ** -2 + v ** -2, delta=1e-4)
                    settings().measure = "STRETCH_L2"
                    bpy.ops.papilla.measure()
                    self.assertAlmostEqual(values_of(obj)[0], ((u ** -2 + v ** -2) / 2) ** 0.5, delta=1e-5)

    def test_an_isometry_is_the_first_colour_and_the_worst_the_last_one(self):
        obj = self.stretched_plane(1, 1)
        bpy.ops.papilla.measure()
        self.assertEqual(bytes_of(colours_of(obj))[0].tolist(), [68, 1, 84])
        settings().worst = 4.0001
        obj.data.uv_layers["UVMap"].data[0].uv.x += 5
        bpy.ops.papilla.measure()
        self.assertEqual(bytes_of(colours_of(obj))[0].tolist(), [253, 231, 37])

    def test_flipped_and_degenerate_faces_are_red(self):
        obj = self.stretched_plane(1, 1)
        bpy.ops.mesh.primitive_plane_add(size=0.1, location=(1, 0, 0))
        bpy.context.object.select_set(True)
        other = bpy.context.object
        for corner in other.data.uv_layers["UVMap"].data:
            corner.uv = (3, 3)
        obj.select_set(True)
        bpy.ops.papilla.measure()
        self.assertEqual(bytes_of(colours_of(other))[0].tolist(), [220, 30, 30])
        self.assertEqual(values_of(other)[0], -1)
        self.assertEqual(bytes_of(colours_of(obj))[0].tolist(), [68, 1, 84])

    def test_colours_are_the_program_s(self):
        obj = suzanne()
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.quads_convert_to_tris()
        bpy.ops.object.mode_set(mode="OBJECT")
        settings().layer, settings().method = "papilla", "triplanar"
        bpy.ops.papilla.unwrap()
        settings().normalize = "scene"
        for engine in engines():
            use_engine(engine)
            settings().worst = 4.7
            bpy.ops.papilla.measure()
            surface = addon.meshes.Surface(obj, bpy.context.scene)
            path = addon.engine.program.pathlib.Path(place("colours.obj"))
            addon.engine.mesh_files.write_obj(path, [surface.mesh(surface.uv("papilla"))])
            run(PROGRAM, "measure", path, "--worst", "4.7", "--colored", place("colours.glb"))
            own = bytes_of(colours_of(obj))[surface.faces]
            theirs = bytes_of(colours_in_glb(place("colours.glb")))
            self.assertEqual(own.shape, theirs.shape)
            self.assertLessEqual(abs(own - theirs).max(), 1)
            self.assertGreater(len(np.unique(own, axis=0)), 50)

    def test_the_legend_has_the_numbers_of_the_colours(self):
        self.stretched_plane(1, 1)
        settings().worst = 6
        bpy.ops.papilla.measure()
        self.assertEqual([step.name for step in settings().legend], ["4", "4.5", "5", "5.5", "6"])
        self.assertEqual([round(255 * c) for c in settings().legend[0].color], [68, 1, 84])
        self.assertEqual([round(255 * c) for c in settings().legend[-1].color], [253, 231, 37])

    def test_a_face_of_several_triangles_has_their_mean_by_area(self):
        values = np.array([4.0, 6.0, 9.0, np.nan])
        mean = addon.distortion.value_per_face(values, np.array([1.0, 3.0, 1.0, 1.0]), np.array([0, 0, 1, 2]), 3)
        np.testing.assert_array_equal(mean, [5.5, 9.0, np.nan])

    def test_measuring_twice_makes_one_attribute(self):
        obj = self.stretched_plane(1, 1)
        bpy.ops.papilla.measure()
        bpy.ops.papilla.measure()
        self.assertEqual(obj.data.color_attributes.keys(), [NAME])
        self.assertEqual(obj.data.color_attributes.active_color.name, NAME)

    def test_a_scale_that_ends_before_it_begins_is_refused(self):
        self.stretched_plane(1, 1)
        settings().worst = 2
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.papilla.measure()
        self.assertIn("the scale must end above 4", str(caught.exception))
