# SPDX-License-Identifier: MIT
"""Whole jobs give the bytes of the program."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import papilla
import shapes

MATERIALS = {
    "materials": {
        "leather": {
            "texture": "leather", "size_mm": [40, 40], "stiffness": 700, "damping": 0.4,
            "staticFriction": 0.5, "dynamicFriction": 0.4, "height": {"depth_mm": 0.3},
        }
    },
    "assign": [{"part": "*", "material": "leather"}],
}  # fmt: skip


class BakeTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        V, F = shapes.cube()
        papilla.write_scene(papilla.single_part_scene(papilla.Part(name="cube", mesh=papilla.mesh(V, F)), "test"),
                            self.folder / "cube.obj")  # fmt: skip
        (self.folder / "materials.json").write_text(json.dumps(MATERIALS))

    def program(self, *arguments):
        subprocess.run([os.environ["PAPILLA_PROGRAM"], *arguments], check=True, cwd=self.folder, capture_output=True)

    def bake(self, **options):
        """In the folder, as the program: names of files are within the result."""
        before = os.getcwd()
        os.chdir(self.folder)
        try:
            rules = papilla.read_materials("materials.json")
            return papilla.bake_file("cube.obj", "python.glb", rules, **options)
        finally:
            os.chdir(before)

    def test_python_equals_the_program(self):
        result = self.bake()
        self.program("bake", "cube.obj", "-m", "materials.json", "-o", "program.glb", "--quiet")
        self.assertEqual((self.folder / "python.glb").read_bytes(), (self.folder / "program.glb").read_bytes())
        self.assertEqual(result.surfaces[0].material, "leather")
        self.assertEqual(result.way.in_place, False)

    def test_options_within_options(self):
        self.bake(read={"millimetres_per_unit": 10.0, "up": "y"}, write={"meshes": "quantize"})
        self.program("bake", "cube.obj", "-m", "materials.json", "-o", "program.glb", "--quiet", "--unit", "cm", "--up", "y",
                     "--compress", "quantize")  # fmt: skip
        self.assertEqual((self.folder / "python.glb").read_bytes(), (self.folder / "program.glb").read_bytes())

    def test_the_plan_names_every_stage(self):
        rules = papilla.read_materials(self.folder / "materials.json")
        plan = papilla.plan_file(self.folder / "cube.obj", rules)
        surface = plan.surfaces[0]
        self.assertEqual((surface.material, len(surface.plan)), ("leather", len(papilla.choices["Stage"])))
        decisions = dict(zip(papilla.choices["Stage"], surface.plan))
        self.assertFalse(decisions["tessellate"].run)
        self.assertTrue(decisions["unwrap"].run)
        self.assertIn("there is none", decisions["unwrap"].reason)

    def test_a_scene_is_baked_in_memory(self):
        rules = papilla.Materials(
            materials={"smooth": {"name": "smooth", "stiffness": 900, "static_friction": 0.3, "dynamic_friction": 0.2}},
            assign=[{"material": "smooth"}],
        )
        scene = papilla.read_scene(self.folder / "cube.obj")
        before = scene.parts[0].mesh.positions.copy()
        result = papilla.bake_scene(scene, rules)
        self.assertEqual(result.scene.materials[0].haptic.stiffness, 900)
        np.testing.assert_array_equal(scene.parts[0].mesh.positions, before)

    def test_cancelled_bakes_write_nothing(self):
        with self.assertRaises(papilla.Cancelled):
            self.bake(progress=lambda stage, fraction: False)
        self.assertFalse((self.folder / "python.glb").exists())


if __name__ == "__main__":
    unittest.main()
