# SPDX-License-Identifier: MIT
"""Each field of work does its job: read, repair, simplify, chart, weather, evaluate, materials, recipes."""
import os
import pathlib
import tempfile
import unittest

import numpy as np
import papilla
import shapes

DATA = pathlib.Path(os.environ["PAPILLA_ROOT"]) / "data"


class ScenesTest(unittest.TestCase):
    def test_scenes_come_back_from_files(self):
        V, F = shapes.cap(6, 6)
        mesh = papilla.mesh(V, F, V[:, :2] / 30)
        scene = papilla.single_part_scene(papilla.Part(name="cap", mesh=mesh), "test")
        with tempfile.TemporaryDirectory() as folder:
            for ending in ("glb", "obj", "ply", "off", "stl"):
                path = os.path.join(folder, "cap." + ending)
                losses = papilla.write_scene(scene, path)
                again = papilla.read_scene(path)
                self.assertIsInstance(losses, list)
                self.assertEqual(papilla.part_statistics(again)[0].triangles, len(F))
                self.assertEqual(papilla.part_statistics(again)[0].has_uv, ending != "stl")
        self.assertEqual(papilla.instances(scene)["world"].shape, (1, 16))

    def test_cad_is_tessellated_to_the_chord(self):
        scene, report = papilla.read_cad(DATA / "exchange" / "handle.step", chord_mm=0.05)
        self.assertLessEqual(report.max_deviation_mm, 0.05)
        self.assertGreater(len(scene.parts[0].mesh.cad_uv.values), 0)
        coarse, _ = papilla.read_cad(DATA / "exchange" / "handle.step", chord_mm=0.5)
        self.assertLess(len(coarse.parts[0].mesh.triangles), len(scene.parts[0].mesh.triangles))

    def test_tags_come_back_from_json(self):
        tag = papilla.MaterialTag(stiffness=650, damping=0.5, static_friction=0.4, dynamic_friction=0.3)
        again, warnings = papilla.parse_material_tag(papilla.material_tag_json(tag))
        self.assertEqual((again.stiffness, again.damping, again.static_friction), (650, 0.5, 0.4))
        self.assertEqual(warnings, [])


class MeshingTest(unittest.TestCase):
    def test_a_soup_is_repaired(self):
        V, F = shapes.cube()
        soup = papilla.mesh(V[F].reshape(-1, 3), np.arange(3 * len(F)).reshape(-1, 3))
        self.assertEqual(papilla.mesh_statistics(soup).boundary_edges, 0)  # Equal positions count as one.
        result = papilla.repair(soup)
        self.assertEqual((len(result.mesh.positions), result.counts.welded_equal, result.settled), (8, 28, True))
        self.assertAlmostEqual(papilla.mesh_statistics(result.mesh).volume_mm3, 30.0**3)
        self.assertEqual(len(papilla.weld_equal(soup).mesh.positions), 8)

    def test_a_plane_is_two_triangles(self):
        V, F = shapes.plane(20, 20)
        result = papilla.simplify(papilla.mesh(V, F), tolerance_mm=0.01)
        self.assertEqual(len(result.mesh.triangles), 2)
        self.assertLessEqual(result.deviation.from_to.bound, 0.01)
        self.assertEqual(result.trace.dtype.names, ("seconds", "error"))

    def test_a_ladder_of_tolerances(self):
        V, F = shapes.bumps(30, 30)
        steps = papilla.simplify_ladder(papilla.mesh(V, F), [0.02, 0.5])
        self.assertGreater(steps[0].triangles, steps[1].triangles)
        welds = papilla.weld_ladder(papilla.mesh(V, F), [0.0, 1e-3])
        self.assertEqual(welds["triangles"].tolist(), [len(F)] * 2)

    def test_a_cube_is_charted(self):
        V, F = shapes.cube()
        result = papilla.segment_charts(papilla.mesh(V, F), disks=True)
        self.assertEqual(len(result.charts.of_triangle), 12)
        self.assertEqual(result.charts.of_triangle.max() + 1, result.charts.count)

    def test_whole_scenes(self):
        V, F = shapes.bumps(24, 24)
        scene = papilla.single_part_scene(papilla.Part(name="bumps", mesh=papilla.mesh(V, F)), "test")
        self.assertEqual(papilla.repair_scene(scene).before.triangles, len(F))
        light = papilla.simplify_scene(scene, tolerance_mm=0.3)
        self.assertLess(light.triangles_after, light.triangles_before)
        unwrapped = papilla.unwrap_scene(scene, method={"method": "best"})
        distortion = papilla.measure_scene(unwrapped.scene)
        self.assertEqual(distortion.report.flipped, 0)
        self.assertEqual(papilla.worst_chart(distortion).part, 0)
        atlas = papilla.pack_atlas(unwrapped.scene.parts[0].mesh.uv, papilla.uv_charts(unwrapped.scene.parts[0].mesh))
        self.assertGreater(atlas.fill_rate, 0.3)


class ProceduralTest(unittest.TestCase):
    def test_a_recipe_is_rendered(self):
        texture = papilla.compile_texture("leather", seed=3)
        channels = papilla.render_texture(texture, ["color", "bump"], width=32, height=24)
        self.assertEqual((channels["color"].shape, channels["bump"].shape), ((24, 32, 3), (24, 32)))
        self.assertEqual(channels["bump"].dtype, np.float32)
        self.assertGreater(channels["bump"].std(), 0)
        relief = papilla.render_relief(texture, 32, 24, 40.0, 30.0, 0.3)
        np.testing.assert_allclose(np.asarray(relief), 0.3 * channels["bump"], rtol=1e-6)

    def test_a_library_of_ones_own(self):
        library = papilla.RecipeLibrary()
        library.add("my_ribs", "stripes|scale=.1") if "stripes" in library.recipes else library.add("my_ribs", "leather")
        self.assertIn("my_ribs", library.recipes)
        self.assertIn("my_ribs", papilla.compile_texture("my_ribs", library).recipes_used)
        with self.assertRaisesRegex(papilla.InvalidInput, "no_such_recipe"):
            papilla.compile_texture("no_such_recipe", library)
        self.assertNotEqual(papilla.mutate_recipe("leather", 1, 0.2), papilla.mutate_recipe("leather", 2, 0.2))

    def test_channels_become_files(self):
        with tempfile.TemporaryDirectory() as folder:
            files = papilla.write_texture_files("leather", folder, width=16, height=16, channels=["bump"])
            self.assertEqual([(f.channel, os.path.exists(os.path.join(folder, f.file))) for f in files.channels], [("bump", True)])


class MaterialsTest(unittest.TestCase):
    def test_the_library_is_searched(self):
        library = papilla.MaterialLibrary()
        materials = library.materials()
        self.assertEqual([m.id for m in materials], library.ids)
        hits = papilla.search_materials(materials, "leather")
        self.assertIn("leather", materials[hits[0].material].id)
        material = library.material(library.ids[0])
        rule = papilla.rule_of(material, "mine")
        self.assertEqual(rule.stiffness, material.stiffness.value)
        with self.assertRaisesRegex(papilla.InvalidInput, "no-such"):
            library.material("no-such/material")

    def test_surfaces_get_suggestions(self):
        V, F = shapes.cube()
        scene = papilla.single_part_scene(papilla.Part(name="leather_seat", mesh=papilla.mesh(V, F)), "test")
        plan = papilla.plan_bake(scene, papilla.Materials())
        found = papilla.suggest_materials(plan.scene, plan.surfaces, papilla.MaterialLibrary().materials())
        self.assertIn("leather", found[0].material)


class WeatherTest(unittest.TestCase):
    def test_dust_lies_on_a_surface(self):
        V, F, uv = shapes.half_cylinder(12, 4)
        part = papilla.Part(name="arm", mesh=papilla.mesh(V, F, uv / 40), materials=[0])
        scene = papilla.single_part_scene(part, "test")
        scene.materials = [papilla.Material(name="paint")]
        config = papilla.WeatherConfig(size=32, sky_rays=8, layers=[{"recipe": "dust"}])
        result = papilla.weather_scene(scene, config, 1.0)
        self.assertEqual((result.painted, result.materials[0].skipped), (1, ""))
        self.assertIsNotNone(result.scene.materials[0].base_color_texture)


class EvaluateTest(unittest.TestCase):
    def test_error_over_run_time(self):
        evaluation = papilla.evaluate(kind="fractal", seconds=1, repeats=1)
        drawn = [run for run in evaluation.runs if len(run.trace)]
        self.assertTrue(drawn)
        front = papilla.pareto_front([run for run in drawn if run.error_name == drawn[0].error_name])
        self.assertTrue((np.diff(front["seconds"]) > 0).all() and (np.diff(front["error"]) < 0).all())
        self.assertIn("param", dict(papilla.evaluation_kinds()))
        with self.assertRaisesRegex(papilla.InvalidInput, "no-such-kind"):
            papilla.evaluate(kind="no-such-kind")


if __name__ == "__main__":
    unittest.main()
