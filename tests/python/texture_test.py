# SPDX-License-Identifier: MIT
import os
import tempfile
import unittest

import numpy as np
import papilla


def wave(size=64, periods=4):
    x = np.arange(size) * 2 * np.pi * periods / size
    return np.sin(x)[None, :] * np.ones((size, 1))


class TextureTest(unittest.TestCase):
    def test_the_dimension_of_a_synthesised_surface(self):
        surface = papilla.brownian_surface_exact(size=257, hurst=0.3, seed=5)
        picture = papilla.to_grey_image(surface)
        readings = papilla.read_fractal_dimensions(picture)
        self.assertAlmostEqual(readings.best.estimate.dimension, 2.7, delta=0.1)
        self.assertEqual(papilla.box_dimension(picture).dimension, readings.box.dimension)
        self.assertEqual(readings.box.curve.dtype.names, ("scale", "measure"))

    def test_spectral_surfaces_tile_and_are_seeded(self):
        one, two = (np.asarray(papilla.spectral_surface(size=64, seed=s)) for s in (1, 2))
        self.assertEqual((one.dtype, one.shape), (np.float64, (64, 64)))
        self.assertFalse(np.array_equal(one, two))
        np.testing.assert_array_equal(one, np.asarray(papilla.spectral_surface(size=64, seed=1)))
        graph = papilla.brownian_graph(levels=6)
        self.assertEqual((graph.dtype, len(graph)), (np.float64, 65))

    def test_a_lattice_is_found(self):
        x, y = np.meshgrid(np.arange(128), np.arange(128))
        picture = 0.5 + 0.25 * np.sin(2 * np.pi * x / 16) + 0.25 * np.sin(2 * np.pi * y / 16)
        analysis = papilla.analyze_symmetry(papilla.GreyImage(picture))
        self.assertTrue(analysis.lattice.found)
        np.testing.assert_allclose(np.abs(np.linalg.det(analysis.lattice.vectors_px)), 256, rtol=0.05)

    def test_roughness_of_a_sine_is_its_rms(self):
        relief = papilla.HeightMap(0.2 * wave(), pitch_mm_x=0.1, pitch_mm_y=0.1, periodic=True)
        self.assertAlmostEqual(papilla.measure_roughness(relief, dimension=False).rms_mm, 0.2 / np.sqrt(2), places=6)

    def test_a_normal_map_of_a_plane_points_up(self):
        relief = papilla.HeightMap(np.zeros((8, 8)), pitch_mm_x=0.1, pitch_mm_y=0.1)
        colours = np.asarray(papilla.normal_map(relief)).reshape(-1, 3)
        self.assertLessEqual(np.abs(colours.astype(int) - [128, 128, 255]).max(), 1)

    def test_relief_from_shading(self):
        grain = papilla.synthesize_grain("spheres6", size_px=128, size_mm=20)
        result = papilla.height_from_image(grain.picture, light=[-0.5, -0.5, 0.7071], depth_mm=0.3, pitch_mm=20 / 128)
        found, truth = np.asarray(result.map).ravel(), np.asarray(grain.relief).ravel()
        self.assertGreater(np.corrcoef(found, truth)[0, 1], 0.7)
        shaded = papilla.shape_from_shading_variational(grain.picture, iterations=5)
        self.assertEqual(len(shaded.height_px), 128 * 128)

    def test_stereo_of_four_lights(self):
        height = 2 * wave(64, 2)
        slope = np.gradient(height, axis=1)
        normal = np.stack([-slope, np.zeros_like(slope), np.ones_like(slope)], -1)
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        lights = np.array([[0.5, 0, 0.9], [-0.5, 0, 0.9], [0, 0.5, 0.9], [0, -0.5, 0.9]])
        lights /= np.linalg.norm(lights, axis=1, keepdims=True)
        pictures = [papilla.GreyImage(0.8 * np.clip(normal @ light, 0, 1)) for light in lights]
        found = papilla.photometric_stereo(pictures, lights=lights).height_px.reshape(64, 64)
        self.assertGreater(np.corrcoef(found.ravel(), height.ravel())[0, 1], 0.98)

    def test_pictures_come_back_from_files(self):
        samples = np.random.default_rng(1).random((6, 9)).astype(np.float32)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "samples.tif")
            papilla.write_grey_image(path, papilla.GreyImage(samples), 32)
            np.testing.assert_array_equal(np.asarray(papilla.read_grey_image(path)), samples)
            png = os.path.join(folder, "noise.png")
            surface = papilla.to_grey_image(papilla.spectral_surface(size=128))
            papilla.write_grey_image(png, surface, 16)
            survey = papilla.survey_picture(png, symmetry=False)
            self.assertEqual((survey.width, survey.bits), (128, 16))
            self.assertIsNotNone(survey.fractal)

    def test_synthesis_by_name(self):
        for grain in ("leather", None):
            made = papilla.synthesize_texture(grain=grain, size_px=65 if grain is None else 64, method="exact")
            self.assertEqual(made.method, grain or "exact")
            self.assertEqual(np.asarray(made.relief).shape[0], 64 if grain else 65)


if __name__ == "__main__":
    unittest.main()
