# SPDX-License-Identifier: MIT
import os
import tempfile
import unittest

import numpy as np
import papilla
import shapes


class ErrorsTest(unittest.TestCase):
    def setUp(self):
        self.V, self.F = shapes.plane(2, 2)

    def test_classes_and_their_exit_codes(self):
        codes = {"UsageError": 2, "InvalidInput": 3, "IoError": 3, "SolverFailure": 4, "DeviceError": 5}
        for name, code in codes.items():
            error = getattr(papilla, name)
            self.assertTrue(issubclass(error, papilla.Error))
            self.assertEqual(error.exit_code, code)
        self.assertTrue(issubclass(papilla.InvalidInput, ValueError))
        self.assertTrue(issubclass(papilla.IoError, OSError))
        self.assertTrue(issubclass(papilla.UsageError, TypeError))

    def test_the_text_is_that_of_the_library(self):
        self.V[3, 1] = np.nan
        with self.assertRaisesRegex(papilla.InvalidInput, r"position"):
            papilla.distortion(self.V, self.F, self.V[:, :2])

    def test_an_index_out_of_range(self):
        self.F[1, 2] = 99
        with self.assertRaises(papilla.InvalidInput):
            papilla.repair(papilla.mesh(self.V, self.F))

    def test_a_missing_file_is_named(self):
        with self.assertRaisesRegex(papilla.IoError, "no/such/file.obj"):
            papilla.read_scene("no/such/file.obj")

    def test_a_damaged_file_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bad.obj")
            with open(path, "w") as file:
                file.write("v 0 0 0\nf 1 2 3\n")
            with self.assertRaisesRegex(papilla.InvalidInput, "bad.obj"):
                papilla.read_scene(path)

    def test_an_unknown_option_names_the_nearest(self):
        with self.assertRaisesRegex(papilla.UsageError, "RepairOptions has no 'weld'.*weld_mm"):
            papilla.repair(papilla.mesh(self.V, self.F), weld=1.0)

    def test_an_unknown_choice_lists_all(self):
        with self.assertRaisesRegex(papilla.UsageError, "UnwrapMethod 'lcsm'; there are: natural.*lscm"):
            papilla.parameterize(self.V, self.F, method="lcsm")

    def test_wrong_types_name_the_place(self):
        mesh = papilla.mesh(self.V, self.F)
        with self.assertRaisesRegex(papilla.UsageError, r"repair: mesh: needs TriangleMesh, got list"):
            papilla.repair([1, 2, 3])
        with self.assertRaisesRegex(papilla.UsageError, r"RepairOptions.max_passes: needs int, got str"):
            papilla.repair(mesh, max_passes="many")
        with self.assertRaisesRegex(papilla.UsageError, r"RepairOptions.max_passes: needs an integer from 0 to 18446744073709551615, got 1180591620717411303424"):
            papilla.repair(mesh, max_passes=2**70)
        with self.assertRaisesRegex(papilla.UsageError, r"TriangleMesh.positions: needs an array of shape \(n, 3\), got \(9, 2\)"):
            mesh.positions = self.V[:, :2]
        with self.assertRaisesRegex(papilla.UsageError, r"TriangleMesh.triangles: needs int32, got float64"):
            mesh.triangles = self.F.astype(float)
        with self.assertRaisesRegex(papilla.UsageError, r"out of the range of int32"):
            mesh.triangles = self.F + 2**40
        with self.assertRaisesRegex(papilla.UsageError, r"uv: has 8 values for 9 positions"):
            papilla.distortion(self.V, self.F, self.V[:8, :2])

    def test_wrong_calls(self):
        with self.assertRaisesRegex(papilla.UsageError, r"distortion\(\) needs 'uv'"):
            papilla.distortion(self.V, self.F)
        with self.assertRaisesRegex(TypeError, "at most 3 positional"):
            papilla.distortion(self.V, self.F, self.V, 1)
        with self.assertRaisesRegex(papilla.UsageError, "progress: needs a function"):
            papilla.repair(papilla.mesh(self.V, self.F), progress=3)
        with self.assertRaises(AttributeError):
            papilla.RepairOptions().weld = 1

    def test_a_chart_without_a_map_is_a_solver_failure_or_invalid(self):
        V, F = shapes.cube()
        mesh = papilla.mesh(V, F)
        charts = papilla.ChartSet(of_triangle=np.zeros(len(F), int), count=1)
        with self.assertRaisesRegex((papilla.InvalidInput, papilla.SolverFailure), r"chart\[0\]"):
            papilla.flatten_lscm(mesh, charts, fall_back=False)

    def test_an_unknown_device(self):
        with self.assertRaisesRegex(papilla.DeviceError, "touch"):
            papilla.device_caps("tuch")


if __name__ == "__main__":
    unittest.main()
