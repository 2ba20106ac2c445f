# SPDX-License-Identifier: MIT
"""papilla.distortion() against closed forms that share no code with it."""
import unittest

import numpy as np
import papilla
import shapes


def singular_values(V, F, uv):
    """Of the affine map of every triangle from its own plane to uv, and its areas in space and in uv."""
    a, b, c = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
    x = b - a
    length = np.linalg.norm(x, axis=1)
    x = x / length[:, None]
    normal = np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1) / 2
    y = np.cross(normal / (2 * area[:, None]), x)
    along, up = ((c - a) * x).sum(1), ((c - a) * y).sum(1)
    p, q, r = (uv[F[:, k]] for k in range(3))
    # Columns of the Jacobian: images of x and of y.
    jx = (q - p) / length[:, None]
    jy = (r - p - jx * along[:, None]) / up[:, None]
    trace = (jx**2 + jy**2).sum(1)
    det = jx[:, 0] * jy[:, 1] - jx[:, 1] * jy[:, 0]
    root = np.sqrt(np.maximum(trace**2 - 4 * det**2, 0))
    return np.sqrt((trace + root) / 2), np.sqrt(np.maximum((trace - root) / 2, 0)), area, det * area


class DistortionTest(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(7)
        self.V, self.F = shapes.bumps(23, 17, 0.1)
        self.uv = self.V[:, :2] + 2.5 * random.standard_normal((len(self.V), 2))

    def test_triangles_have_the_singular_values_of_their_maps(self):
        report = papilla.distortion(self.V, self.F, self.uv, normalize="none")
        s1, s2, area, _ = singular_values(self.V, self.F, self.uv)
        np.testing.assert_allclose(report.per_triangle["sigma1"], s1, rtol=1e-9)
        np.testing.assert_allclose(report.per_triangle["sigma2"], s2, rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose(report.per_triangle["area_mm2"], area, rtol=1e-12)

    def test_means_are_weighted_by_area_in_space(self):
        report = papilla.distortion(self.V, self.F, self.uv, normalize="none")
        s1, s2, area, uv_area = singular_values(self.V, self.F, self.uv)
        weight = area / area.sum()
        dirichlet = s1**2 + s2**2 + s1**-2 + s2**-2
        self.assertAlmostEqual(report.symmetric_dirichlet.mean / (weight @ dirichlet), 1, places=9)
        self.assertAlmostEqual(report.symmetric_dirichlet.max / dirichlet.max(), 1, places=7)
        self.assertAlmostEqual(report.stretch_l2, np.sqrt(weight @ (s1**-2 + s2**-2) / 2), places=7)
        self.assertAlmostEqual(report.stretch_linf / (1 / s2).max(), 1, places=7)
        self.assertAlmostEqual(report.conformal.mean / (weight @ (s1 / s2)), 1, places=7)
        self.assertAlmostEqual(report.area_ratio.mean, weight @ (s1 * s2), places=9)
        self.assertEqual(report.flipped, int((uv_area < 0).sum()))
        self.assertGreater(report.flipped, 0)

    def test_normalization_makes_the_areas_agree(self):
        scaled = papilla.distortion(self.V, self.F, 7.5 * self.uv)
        s1, s2, area, uv_area = singular_values(self.V, self.F, self.uv)
        s = np.sqrt(area.sum() / np.abs(uv_area).sum())
        np.testing.assert_allclose(scaled.per_triangle["sigma1"], s * s1, rtol=1e-9)
        np.testing.assert_allclose(scaled.per_triangle["sigma2"], s * s2, rtol=1e-6, atol=1e-9)

    def test_an_isometry_has_energy_four(self):
        V, F, uv = shapes.half_cylinder(400, 4)
        report = papilla.distortion(V, F, uv, normalize="none")
        # A chord is sin(x)/x of its arc: (π/800)² / 6 off.
        self.assertAlmostEqual(report.symmetric_dirichlet.mean, 4, places=8)
        self.assertLess(report.angle_error_deg.max, 0.01)

    def test_a_stretch_along_one_axis(self):
        V, F = shapes.plane()
        report = papilla.distortion(V, F, V[:, :2] * [3, 1], normalize="none")
        self.assertAlmostEqual(report.symmetric_dirichlet.mean, 9 + 1 + 1 / 9 + 1, places=12)
        self.assertAlmostEqual(report.area_ratio.mean, 3, places=12)
        self.assertAlmostEqual(report.conformal.max, 3, places=12)

    def test_edge_lengths_of_maillot(self):
        V, F = shapes.plane(5, 4)
        report = papilla.distortion(V, F, V[:, :2] * 2, normalize="none")
        # d = 2 D for every edge: (4 D² - D²)² / D² = 9 D².
        self.assertAlmostEqual(report.maillot_length, 9, places=12)
        self.assertAlmostEqual(report.edge_length_error, 1, places=12)

    def test_uv_per_position_per_corner_and_indexed_are_one(self):
        per_position = papilla.distortion(self.V, self.F, self.uv)
        per_corner = papilla.distortion(self.V, self.F, self.uv[self.F])
        indexed = papilla.distortion(self.V, self.F, papilla.CornerVec2(values=self.uv, indices=self.F))
        mesh = papilla.mesh(self.V, self.F, self.uv)
        of_mesh = papilla.measure_distortion(mesh, mesh.uv)
        for other in (per_corner, indexed, of_mesh):
            np.testing.assert_array_equal(per_position.per_triangle, other.per_triangle)

    def test_a_fold_overlaps(self):
        V, F = shapes.plane(2, 1, 20, 10)
        folded = np.column_stack([10 - np.abs(V[:, 0] - 10), V[:, 1]])
        report = papilla.distortion(V, F, folded, normalize="none")
        self.assertAlmostEqual(report.overlap_area_fraction, 1, places=9)
        self.assertEqual(papilla.distortion(V, F, folded, overlap=False).overlapping_triangles, 0)


class ParameterizeTest(unittest.TestCase):
    def test_every_method_maps_a_cap_and_the_referee_agrees(self):
        V, F = shapes.cap(12, 12)
        for method in papilla.choices["UnwrapMethod"]:
            with self.subTest(method):
                if method == "natural":  # It needs parameters of CAD.
                    with self.assertRaises(papilla.InvalidInput):
                        papilla.parameterize(V, F, method=method, natural={"fall_back": False})
                    continue
                part = papilla.parameterize(V, F, method=method, charts="keep")
                uv = part.flattening.uv
                self.assertEqual(uv.indices.shape, F.shape)
                self.assertTrue(np.isfinite(uv.values).all())
                report = papilla.distortion(V, F, uv)
                if method != "environment":  # It is a mirror's image, no map in true size.
                    self.assertEqual(report.flipped, 0)
                    self.assertLess(report.symmetric_dirichlet.mean, 7)

    def test_a_half_cylinder_unrolls(self):
        V, F, _ = shapes.half_cylinder()
        part = papilla.parameterize(V, F, method="lscm", charts="keep")
        report = papilla.distortion(V, F, part.flattening.uv, normalize="none")
        self.assertAlmostEqual(report.symmetric_dirichlet.mean, 4, places=5)
        self.assertEqual((part.method, report.flipped, part.flattening.charts.count), ("lscm", 0, 1))

    def test_options_of_a_method_are_a_dictionary_or_a_struct(self):
        V, F = shapes.cap(10, 10)
        one = papilla.parameterize(V, F, method="lscm", charts="keep", lscm={"solver": "cgal"})
        two = papilla.parameterize(V, F, method="lscm", charts="keep", lscm=papilla.LscmOptions(solver="cgal"))
        three = papilla.parameterize(
            V, F, options=papilla.MethodOptions(method="lscm", charts="keep", lscm={"solver": "cgal"})
        )
        np.testing.assert_array_equal(one.flattening.uv.values, two.flattening.uv.values)
        np.testing.assert_array_equal(one.flattening.uv.values, three.flattening.uv.values)
        other = papilla.parameterize(V, F, method="lscm", charts="keep")
        self.assertFalse(np.array_equal(one.flattening.uv.values, other.flattening.uv.values))


if __name__ == "__main__":
    unittest.main()
