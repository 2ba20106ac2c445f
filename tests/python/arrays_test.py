# SPDX-License-Identifier: MIT
"""Arrays are looked at in place, and stay good whatever becomes of what they look at."""
import copy
import gc
import unittest

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
