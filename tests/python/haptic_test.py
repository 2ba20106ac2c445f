# SPDX-License-Identifier: MIT
"""Contact: forces at positions against the spring's formula, whole strokes against the player."""
import os
import subprocess
import tempfile
import unittest

import numpy as np
import papilla
import shapes

STIFFNESS = 400.0


def plate(**tag):
    """A plate of 40 mm a side in the plane z = 0, felt from above."""
    V, F = shapes.plane()
    scene = papilla.single_part_scene(papilla.Part(name="plate", mesh=papilla.mesh(V, F), materials=[0]), "test")
    scene.up = "y"
    scene.materials = [papilla.Material(name="plate", haptic={"stiffness": STIFFNESS, **tag})]
    return scene


def way(depth_m, ticks, at=(0.02, 0.02)):
    """Down onto the plate to a depth of the probe's lowest point, from 2 mm above, then stays there."""
    height = np.concatenate([np.linspace(0.002, -depth_m, ticks), np.full(ticks, -depth_m)])
    return np.column_stack([np.full(len(height), at[0]), np.full(len(height), at[1]), height])


class ContactTest(unittest.TestCase):
    def setUp(self):
        self.scene = papilla.haptic_scene(plate(), "plate")
        self.surface = papilla.contact_surface(self.scene)

    def test_the_surface(self):
        self.assertEqual((self.surface.triangles, self.surface.material_count), (128, 1))
        self.assertEqual(self.scene.names, ("plate",))
        self.assertEqual(self.surface.material(0).stiffness, STIFFNESS)
        np.testing.assert_allclose(self.surface.high - self.surface.low, [0.04, 0.04, 0], atol=1e-6)
        clearance = self.surface.clearance([[0.02, 0.02, 0.003], [0.02, 0.02, 0.001]], 0.01)
        np.testing.assert_allclose(clearance, np.array([0.003, 0.001]) - self.surface.probe_radius_m - self.surface.skin_m, atol=1e-7)
        nearest = self.surface.closest_point([0.01, 0.01, 0.002], 0.01)
        np.testing.assert_allclose(nearest.point, [0.01, 0.01, 0], atol=1e-7)
        self.assertIsNone(self.surface.closest_point([1, 1, 1], 0.01))

    def test_a_spring_at_rest(self):
        depth = 0.001
        tick = papilla.HapticTick(self.surface)
        # Forces fade in with the first contact; the second one has them in full.
        positions = np.vstack([way(depth, 1000)] * 2) + [0, 0, self.surface.probe_radius_m]
        forces = tick.forces(positions)
        self.assertEqual((forces.shape, forces.dtype), ((4000, 3), np.float64))
        np.testing.assert_allclose(forces[-1], [0, 0, STIFFNESS * depth], atol=1e-3)
        np.testing.assert_array_equal(forces[:400], np.zeros((400, 3)))  # In the air.
        self.assertTrue(tick.in_contact)
        one_by_one = papilla.HapticTick(self.surface)
        np.testing.assert_array_equal([one_by_one.force(p) for p in positions], forces)
        np.testing.assert_allclose(tick.proxy[2], self.surface.probe_radius_m + self.surface.skin_m, atol=1e-5)

    def test_friction_is_that_of_coulomb(self):
        scene = papilla.haptic_scene(plate(static_friction=0.3, dynamic_friction=0.3), "plate")
        surface = papilla.contact_surface(scene)
        press = way(0.001, 1000, (0.01, 0.02))
        slide = np.repeat(press[-1:], 1000, 0)
        slide[:, 0] += np.linspace(0, 0.02, 1000)
        forces = papilla.HapticTick(surface).forces(np.vstack([press, slide]) + [0, 0, surface.probe_radius_m])
        along, normal = forces[2500:2900, 0].mean(), forces[2500:2900, 2].mean()
        self.assertAlmostEqual(-along / normal, 0.3, places=2)

    def test_a_limit_of_force(self):
        tick = papilla.HapticTick(self.surface, limits=papilla.safety_limits(0.2))
        forces = tick.forces(way(0.005, 2000))
        self.assertLessEqual(np.linalg.norm(forces, axis=1).max(), 0.2 + 1e-12)

    def test_bad_positions(self):
        tick = papilla.HapticTick(self.surface)
        np.testing.assert_array_equal(tick.force([np.nan, 0, 0]), [0, 0, 0])
        with self.assertRaises(papilla.UsageError):
            tick.forces([[1, 2]])

    def test_it_outlives_the_surface(self):
        tick = papilla.HapticTick(papilla.contact_surface(self.scene))
        self.assertEqual(tick.force([0, 0, 1]).shape, (3,))


class StrokeTest(unittest.TestCase):
    def setUp(self):
        self.scene = papilla.haptic_scene(plate(static_friction=0.3, dynamic_friction=0.2), "plate")
        self.surface = papilla.contact_surface(self.scene)
        self.largest = papilla.largest_material(self.scene)

    def stroke(self, **options):
        return papilla.press_and_stroke(self.surface, self.largest.material, self.largest.centre, **options)

    def test_a_stroke_as_arrays(self):
        hand = self.stroke(seconds=1.0)
        played = papilla.simulate(self.surface, hand, papilla.device_caps("touch"), ticks=1000)
        rows = played.rows
        self.assertEqual(rows.dtype.names, ("t", "hand", "probe", "proxy", "force", "in_contact"))
        self.assertEqual((len(rows), rows["force"].shape), (1000, (1000, 3)))
        np.testing.assert_allclose(rows["t"], np.arange(1000) / 1000, atol=1e-12)
        self.assertEqual(played.loop.contact_ticks, int(rows["in_contact"].sum()))
        self.assertAlmostEqual(played.loop.max_force_n, np.linalg.norm(rows["force"], axis=1).max())
        again = papilla.simulate(self.surface, hand, papilla.device_caps("touch"), ticks=1000)
        np.testing.assert_array_equal(again.rows["force"], rows["force"])

    def test_a_hand_of_ones_own(self):
        hand = papilla.Trajectory([0, 0.5, 1], [[0.02, 0.02, 0.01], [0.02, 0.02, -0.002], [0.02, 0.02, -0.002]])
        self.assertEqual((hand.start_s, hand.end_s), (0, 1))
        np.testing.assert_allclose(hand.position(0.25), [0.02, 0.02, 0.004])
        caps = papilla.device_caps("touch")
        rows = papilla.simulate(self.surface, hand, caps, ticks=1000).rows
        self.assertTrue(rows["in_contact"][-1])
        with self.assertRaisesRegex(papilla.InvalidInput, "sample"):
            papilla.Trajectory([0, 0], [[0, 0, 0]] * 2)

    def test_progress_cancels(self):
        with self.assertRaises(papilla.Cancelled):
            papilla.simulate(self.surface, self.stroke(), papilla.device_caps("touch"), ticks=10**6,
                             progress=lambda stage, fraction: False)  # fmt: skip

    def test_python_equals_the_player(self):
        with tempfile.TemporaryDirectory() as folder:
            path, record = os.path.join(folder, "plate.glb"), os.path.join(folder, "stroke.csv")
            papilla.write_scene(plate(static_friction=0.3, dynamic_friction=0.2), path)
            subprocess.run([os.environ["PAPILLA_PLAYER"], path, "--device", "sim:touch", "--seconds", "1", "--record", record,
                            "--quiet"], check=True, capture_output=True)  # fmt: skip
            recorded = np.loadtxt(record, delimiter=",", skiprows=1)
            caps = papilla.device_caps("touch")
            speed = papilla.StrokeOptions().speed_m_per_s
            scene = papilla.load_haptic_scene(path, probe_radius_m=caps.probe_radius_m, shortest_wave_m=2 * speed / 1000)
            surface = papilla.contact_surface(scene)
            largest = papilla.largest_material(scene)
            hand = papilla.press_and_stroke(surface, largest.material, largest.centre, seconds=1.0)
            rows = papilla.simulate(surface, hand, caps, ticks=1000).rows
        np.testing.assert_array_equal(recorded[:, 10:13], rows["force"])
        np.testing.assert_array_equal(recorded[:, 1:4], rows["hand"])


if __name__ == "__main__":
    unittest.main()
