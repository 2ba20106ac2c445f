# SPDX-License-Identifier: MIT
"""Arrays are looked at in place, and stay good whatever becomes of what they look at."""
import copy
import gc
import subprocess
import sys
import unittest
import weakref

import numpy as np
import papilla
import shapes


class ArraysTest(unittest.TestCase):
    def setUp(self):
        self.V, self.F = shapes.plane(4, 3)
        self.mesh = papilla.mesh(self.V, self.F)

    def test_no_copies(self):
        positions = self.mesh.positions
        self.assertTrue(np.shares_memory(positions, self.mesh.positions))
        self.assertEqual((positions.dtype, positions.shape), (np.float64, (20, 3)))
        self.assertEqual((self.mesh.triangles.dtype, self.mesh.triangles.shape), (np.int32, (24, 3)))
        positions[0] = [1, 2, 3]
        np.testing.assert_array_equal(self.mesh.positions[0], [1, 2, 3])

    def test_no_copies_through_a_scene(self):
        scene = papilla.single_part_scene(papilla.Part(name="plate", mesh=self.mesh), "test")
        self.assertTrue(np.shares_memory(scene.parts[0].mesh.positions, scene.parts[0].mesh.positions))
        scene.parts[0].mesh.positions[:] *= 2
        np.testing.assert_allclose(scene.parts[0].mesh.positions, 2 * self.V)
        scene.parts[0].name = "board"
        self.assertEqual(scene.parts[0].name, "board")

    def test_results_are_not_copied(self):
        report = papilla.distortion(self.V, self.F, self.V[:, :2])
        self.assertTrue(np.shares_memory(report.per_triangle, report.per_triangle))
        self.assertEqual(report.per_triangle["chart"].dtype, np.int32)

    def test_an_array_outlives_its_owner(self):
        positions = papilla.mesh(self.V, self.F).positions
        gc.collect()
        np.testing.assert_array_equal(positions, self.V)

    def test_an_array_keeps_what_it_looked_at_when_the_field_is_assigned(self):
        before = self.mesh.positions
        self.mesh.positions = np.zeros((100000, 3))
        np.testing.assert_array_equal(before, self.V)
        self.assertEqual(self.mesh.positions.shape, (100000, 3))
        self.assertFalse(np.shares_memory(before, self.mesh.positions))
        self.mesh.positions = self.mesh.positions + 1
        self.assertEqual(self.mesh.positions[0, 0], 1)

    def test_and_when_the_whole_struct_is_assigned(self):
        part = papilla.Part(mesh=self.mesh)
        before = part.mesh.positions
        part.mesh = papilla.mesh(2 * self.V, self.F)
        np.testing.assert_array_equal(before, self.V)
        np.testing.assert_array_equal(part.mesh.positions, 2 * self.V)

    def test_elements_outlive_their_list(self):
        scene = papilla.Scene(parts=[{"name": "a", "mesh": self.mesh}, {"name": "b"}])
        first, second = scene.parts
        scene.parts = [second]
        del scene
        gc.collect()
        self.assertEqual((first.name, second.name), ("a", "b"))
        np.testing.assert_array_equal(first.mesh.positions, self.V)

    def test_an_optional_struct_in_use_stays(self):
        material = papilla.Material(haptic={"stiffness": 700})
        tag = material.haptic
        tag.stiffness = 800
        self.assertEqual(material.haptic.stiffness, 800)
        with self.assertRaisesRegex(papilla.UsageError, "still refers"):
            material.haptic = None
        del tag
        material.haptic = None
        self.assertIsNone(material.haptic)

    def test_minus_one_stands_for_no_value(self):
        self.mesh.uv = papilla.CornerVec2(values=self.V[:, :2], indices=self.F)
        self.mesh.uv.indices[3] = -1
        self.assertEqual(papilla.distortion(self.V, self.F, self.mesh.uv).without_uv, 1)
        again = papilla.CornerVec2(values=self.V[:, :2], indices=self.mesh.uv.indices)
        np.testing.assert_array_equal(again.indices[3], [-1, -1, -1])

    def test_integers_of_any_kind_and_lists_are_taken(self):
        for F in (self.F.astype(np.uint8), self.F.astype(np.uint64), self.F.tolist(), self.F[::-1][::-1]):
            np.testing.assert_array_equal(papilla.mesh(self.V.tolist(), F).triangles, self.F)
        empty = papilla.mesh([], [])
        self.assertEqual((empty.positions.shape, empty.triangles.shape), ((0, 3), (0, 3)))

    def test_copies_are_deep(self):
        other = copy.copy(self.mesh)
        self.assertFalse(np.shares_memory(other.positions, self.mesh.positions))
        np.testing.assert_array_equal(other.positions, self.mesh.positions)
        self.assertFalse(np.shares_memory(copy.deepcopy(self.mesh).positions, self.mesh.positions))

    def test_pictures_have_the_buffer_protocol(self):
        samples = np.linspace(0, 1, 12, dtype=np.float32).reshape(3, 4)
        picture = papilla.GreyImage(samples, pitch_mm=0.1)
        view = memoryview(picture)
        self.assertEqual((view.shape, view.format, picture.width, picture.height), ((3, 4), "f", 4, 3))
        array = np.asarray(picture)
        self.assertTrue(np.shares_memory(array, picture.array))
        array[1, 2] = 0.25
        self.assertEqual(view[1, 2], 0.25)
        del picture
        gc.collect()
        self.assertEqual(view[1, 2], 0.25)
        self.assertEqual(memoryview(papilla.ColorImage(np.zeros((2, 5, 3), np.uint8))).shape, (2, 5, 3))
        self.assertEqual(np.asarray(papilla.HeightMap(samples)).shape, (3, 4))

    def test_the_way_in_has_no_copy(self):
        V, F, uv = self.V, self.F.astype(np.int32), self.V[:, :2].copy()
        mesh = papilla.mesh(V, F, uv)
        self.assertTrue(np.shares_memory(mesh.positions, V))
        self.assertTrue(np.shares_memory(mesh.triangles, F))
        self.assertTrue(np.shares_memory(mesh.uv.values, uv))
        self.assertFalse(np.shares_memory(mesh.uv.indices, F))
        V[3] = [1, 2, 3]
        mesh.triangles[0] = mesh.triangles[1]
        np.testing.assert_array_equal(mesh.positions[3], [1, 2, 3])
        np.testing.assert_array_equal(F[0], F[1])
        corners = np.zeros((len(F), 3, 2))
        self.assertTrue(np.shares_memory(papilla.mesh(V, F, corners).uv.values, corners))
        unsigned = F.view(np.uint32)
        self.assertTrue(np.shares_memory(papilla.mesh(V, unsigned).triangles, F))

    def test_nor_have_fields(self):
        count = len(self.F)
        fields = {
            "positions": np.zeros((20, 3)),
            "triangles": np.zeros((count, 3), np.int32),
            "material": np.zeros(count, np.int32),
            "face": np.zeros(count, np.int32),
        }
        for name, array in fields.items():
            setattr(self.mesh, name, array)
            self.assertTrue(np.shares_memory(getattr(self.mesh, name), array), name)
            self.assertTrue(np.shares_memory(getattr(papilla.TriangleMesh(**{name: array}), name), array), name)
        indices = np.zeros((count, 3), np.int32)
        for Corner, values in (
            (papilla.CornerVec2, np.zeros((5, 2))),
            (papilla.CornerVec3, np.zeros((5, 3))),
            (papilla.CornerColor, np.zeros((5, 4), np.float32)),
        ):
            corner = Corner(values=values, indices=indices)
            self.assertTrue(np.shares_memory(corner.values, values), Corner)
            self.assertTrue(np.shares_memory(corner.indices, indices), Corner)

    def test_pictures_look_at_their_array(self):
        for Picture, shape, dtype in (
            (papilla.GreyImage, (3, 4), np.float32),
            (papilla.ColorImage, (3, 4, 3), np.uint8),
            (papilla.RgbaImage, (3, 4, 4), np.uint8),
            (papilla.LinearImage, (3, 4, 3), np.float32),
            (papilla.HeightMap, (3, 4), np.float32),
            (papilla.HeightGrid, (4, 4), np.float64),
        ):
            array = np.arange(np.prod(shape)).reshape(shape).astype(dtype)
            expected = array.copy()
            picture = Picture(array)
            self.assertTrue(np.shares_memory(picture.array, array), Picture)
            picture.array[1, 2] = 7
            np.testing.assert_array_equal(array[1, 2], picture.array[1, 2])
            expected[1, 2] = 7
            del array
            gc.collect()
            np.testing.assert_array_equal(picture.array, expected)
            self.assertFalse(np.shares_memory(Picture(picture.array).array, picture.array), "of another picture")
            self.assertFalse(np.shares_memory(Picture(np.asarray(picture)).array, picture.array), "nor by its buffer")

    def test_what_is_looked_at_outlives_its_names(self):
        V, F = self.V.copy(), self.F.astype(np.int32)
        gone = weakref.ref(V)
        mesh = papilla.mesh(V, F)
        del V, F
        gc.collect()
        [np.full(60, 9.0) for _ in range(100)]
        np.testing.assert_array_equal(mesh.positions, self.V)
        np.testing.assert_array_equal(mesh.triangles, self.F)
        view = mesh.positions
        del mesh
        gc.collect()
        np.testing.assert_array_equal(view, self.V)
        self.assertIsNotNone(gone())
        del view
        gc.collect()
        self.assertIsNone(gone())

    def test_a_call_lets_go_of_its_arrays(self):
        V = self.V.copy()
        gone = weakref.ref(V)
        papilla.distortion(V, self.F, V[:, :2])
        papilla.parameterize(V, self.F, method="lscm")
        papilla.Trajectory(np.arange(20.0), V)
        mesh = papilla.mesh(V, self.F)
        mesh.positions = self.V
        del V
        gc.collect()
        self.assertIsNone(gone())

    def test_what_must_be_converted_or_not_be_written_is_copied(self):
        frozen = self.V.copy()
        frozen.flags.writeable = False
        odd = np.zeros(8 * self.V.size + 1, np.uint8)[1:].view(np.float64).reshape(self.V.shape)
        odd[:] = self.V
        for V in (
            frozen,
            odd,
            self.V.astype(np.float32),
            self.V.astype(">f8"),
            np.asfortranarray(self.V),
            np.hstack([self.V, self.V])[:, 3:],
            np.repeat(self.V, 2, axis=0)[::2],
            self.V[::-1][::-1].tolist(),
        ):
            mesh = papilla.mesh(V, self.F.astype(np.int64))
            np.testing.assert_allclose(mesh.positions, self.V, rtol=1e-6)
            np.testing.assert_array_equal(mesh.triangles, self.F)
            if isinstance(V, np.ndarray):
                self.assertFalse(np.shares_memory(mesh.positions, V))
            mesh.positions[:] = 0
        np.testing.assert_array_equal(frozen, self.V)
        report = papilla.distortion(frozen, self.F, frozen[:, :2])
        self.assertEqual(report.per_triangle.shape, self.F.shape[:1])

    def test_structs_stay_apart(self):
        other = papilla.TriangleMesh(positions=self.mesh.positions, triangles=self.mesh.triangles)
        self.assertFalse(np.shares_memory(other.positions, self.mesh.positions))
        other.positions = self.mesh.positions
        other.normals.values = self.mesh.positions[:5]
        self.assertFalse(np.shares_memory(other.positions, self.mesh.positions))
        self.assertFalse(np.shares_memory(other.normals.values, self.mesh.positions))
        part = papilla.Part(mesh=self.mesh)
        self.assertFalse(np.shares_memory(part.mesh.positions, self.V))
        part.mesh.positions = self.V
        part.mesh = papilla.mesh(5 * self.V, self.F)  # Goes to memory of its own, not into V.
        np.testing.assert_array_equal(self.V, shapes.plane(4, 3)[0])
        np.testing.assert_array_equal(part.mesh.positions, 5 * self.V)

    def test_functions_that_change_a_mesh_leave_the_arrays(self):
        V, F = shapes.cap(10, 10)
        V, F = np.vstack([V, V[:3], V[:1] + 1e-9]), np.vstack([F, F[:4]]).astype(np.int32)
        uv = V[:, :2].copy()
        kept = V.copy(), F.copy(), uv.copy()
        mesh = papilla.mesh(V, F, uv)
        scene = papilla.single_part_scene(papilla.Part(name="a"), "test")
        scene.parts[0].mesh.positions = V
        scene.parts[0].mesh.triangles = F
        papilla.weld_equal(mesh)
        papilla.weld(mesh)
        papilla.repair(mesh)
        papilla.simplify(mesh, tolerance_mm=0.5)
        papilla.parameterize(V, F, method="lscm")
        papilla.distortion(V, F, uv)
        papilla.repair_scene(scene)
        papilla.unwrap_scene(scene)
        for now, before in zip((V, F, uv), kept):
            np.testing.assert_array_equal(now, before)
        self.assertTrue(np.shares_memory(mesh.positions, V))
        self.assertTrue(np.shares_memory(scene.parts[0].mesh.positions, V))

    def test_large_arrays_take_no_memory_on_the_way_in(self):
        code = """
import resource
import numpy as np
import papilla

def peak():
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

V = np.full((2_000_000, 3), 0.5)
V[:3] = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
uv = np.full((2_000_000, 2), 0.5)
uv[:3] = V[:3, :2]
F = np.array([[0, 1, 2]], np.int32)
samples = np.full((4000, 4000), 0.5, np.float32)
papilla.distortion(V[:3], F, uv[:3])
before = peak()
mesh = papilla.mesh(V, F, uv)
mesh.positions = V
picture = papilla.GreyImage(samples)
relief = papilla.HeightMap(samples)
made = peak() - before
before = peak()
papilla.Trajectory(np.array([0.0, 1.0]), V[:2])
try:
    papilla.distortion(V, np.array([[0, 1, 5_000_000]], np.int32), uv)
except papilla.InvalidInput:
    pass
print(made, peak() - before)
"""
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        made, measured = map(int, run.stdout.split())
        self.assertLess(made, 16e6, "of 208 million bytes")
        self.assertLess(measured, 16e6, "of 80 million bytes")

    def test_text_of_a_struct(self):
        text = repr(papilla.RepairOptions(weld_mm=0.25))
        self.assertTrue(text.startswith("RepairOptions(weld_mm=0.25, stitch_mm=None,"), text)
        self.assertIn("<array (20, 3)>", repr(self.mesh))

    def test_what_can_not_be_changed_in_place_is_read_only(self):
        rules = papilla.Materials(materials={"a": {"name": "a"}})
        rules.materials["a"].stiffness = 700
        self.assertEqual(rules.materials["a"].stiffness, 700)
        with self.assertRaises(TypeError):
            rules.materials["b"] = papilla.MaterialRule()
        rules.materials = {**rules.materials, "b": {"name": "b"}}
        self.assertEqual((sorted(rules.materials), rules.materials["a"].stiffness), (["a", "b"], 700))
        self.assertEqual(papilla.Scene(warnings=["one"]).warnings, ("one",))
        self.assertIsNone(papilla.SurveyOptions().pictures)
        self.assertEqual(str(papilla.SurveyOptions(pictures="there").pictures), "there")

    def test_many_assignments_take_no_memory(self):
        storage = [self.mesh.positions]
        for _ in range(1000):
            self.mesh.positions = self.V
            storage = [self.mesh.positions]
        gc.collect()
        np.testing.assert_array_equal(storage[0], self.V)


if __name__ == "__main__":
    unittest.main()
