# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of the library, grain photographs, and the bake."""
import json
import math
import os
import unittest

import bpy

from shapes import PROGRAM, addon, document, empty_scene, engines, place, run, settings, suzanne, tags_of, use_engine

NAPPA = "leather/nappa-fine"


class MaterialTest(unittest.TestCase):
    def setUp(self):
        empty_scene()
        use_engine("PROGRAM")
        settings().method, settings().uv_space, settings().layer = "auto", "MM", "papilla"

    def photograph(self):
        path = place("grain.png")
        if not os.path.exists(path):
            run(PROGRAM, "synthesize", "grain", "--kind", "leather", "--size", "64", "-o", path, "--quiet")
        return path

    def test_a_material_of_the_library_has_its_numbers(self):
        told = next(m for m in json.loads(run(PROGRAM, "materials", "list", "--json", "-"))["materials"] if m["name"] == NAPPA)
        for engine in engines():
            with self.subTest(engine):
                empty_scene()
                use_engine(engine)
                obj = suzanne()
                bpy.ops.papilla.assign_library(material=NAPPA)
                tag = addon.tag_store.read(obj.active_material)
                self.assertEqual(tag, {
                    "version": 2, "stiffness": told["stiffness"], "damping": told["damping"], "staticFriction": told["static_friction"],
                    "dynamicFriction": told["dynamic_friction"], "stribeckVelocity": told["stribeck_velocity"],
                    "backing": {"stiffness": told["backing"]["stiffness"], "depth": told["backing"]["depth_mm"] / 1000}})
                group = obj.active_material.papilla_material
                self.assertEqual((group.library, list(group.size_mm)), (NAPPA, told["height"]["size_mm"]))
                shader = obj.active_material.node_tree.nodes["Principled BSDF"]
                self.assertAlmostEqual(shader.inputs["Roughness"].default_value, told["appearance"]["roughness"], places=6)

    def test_one_material_for_all_objects(self):
        first, second = suzanne(), suzanne()
        first.select_set(True)
        bpy.ops.papilla.assign_library(material=NAPPA)
        bpy.ops.papilla.assign_library(material=NAPPA)
        self.assertEqual(first.active_material, second.active_material)
        self.assertEqual(len([m for m in bpy.data.materials if m.papilla_material.library]), 1)

    def test_a_photograph_lies_on_the_uv_at_its_scale(self):
        obj = suzanne()
        bpy.ops.papilla.unwrap()
        bpy.ops.papilla.assign_grain(filepath=self.photograph(), size_mm=(40, 20), depth_mm=0.3)
        nodes = obj.active_material.node_tree.nodes
        scale = nodes["Papilla Scale"].inputs["Scale"].default_value
        self.assertTrue(math.isclose(scale[0], 1 / 40, rel_tol=1e-6) and math.isclose(scale[1], 1 / 20, rel_tol=1e-6))
        self.assertEqual(nodes["Papilla UV"].uv_map, "papilla")
        settings().uv_space = "ATLAS"
        bpy.ops.papilla.unwrap()
        bpy.ops.papilla.show_grain()
        unit = obj.data["papilla_mm_per_uv"]["papilla"]
        scale = obj.active_material.node_tree.nodes["Papilla Scale"].inputs["Scale"].default_value
        self.assertTrue(math.isclose(scale[0], unit / 40, rel_tol=1e-6))
        self.assertEqual(sum(n.name.startswith("Papilla") for n in obj.active_material.node_tree.nodes), 3)

    def test_a_bake_lays_the_grain_on_the_uv_in_millimetres(self):
        outputs = []
        for engine in engines():
            empty_scene()
            use_engine(engine)
            settings().method, settings().layer = "best", "papilla"
            obj = suzanne()
            bpy.ops.papilla.unwrap()
            bpy.ops.papilla.assign_grain(filepath=self.photograph(), size_mm=(40, 20), depth_mm=0.3)
            group = obj.active_material.papilla_material
            group.stiffness, group.static_friction, group.dynamic_friction, group.unwrap = 640, 0.5, 0.4, "keep"
            bpy.ops.papilla.bake(filepath=place(f"{engine}.glb"))
            self.assertEqual(obj.data.uv_layers.keys(), ["UVMap", "papilla"])  # as before the export
            tag = tags_of(place(f"{engine}.glb"))[obj.active_material.name]
            self.assertEqual((tag["stiffness"], tag["staticFriction"], tag["dynamicFriction"]), (640, 0.5, 0.4))
            height = tag["height"]
            self.assertEqual(height["texCoord"], 0)
            # uv of the file are millimetres; the transform makes them repeats of the photograph.
            self.assertTrue(math.isclose(height["metresPerUV"][0], 0.001, rel_tol=0.02), height)
            self.assertTrue(math.isclose(height["uvTransform"]["scale"][0], 1 / 40, rel_tol=0.02), height)
            self.assertTrue(math.isclose(height["uvTransform"]["scale"][1], 1 / 20, rel_tol=0.02), height)
            with open(place(f"{engine}.glb"), "rb") as file:
                outputs.append(file.read())
        self.assertTrue(all(output == outputs[0] for output in outputs))

    def test_a_baked_file_comes_back_with_its_tags(self):
        suzanne()
        bpy.ops.papilla.assign_library(material=NAPPA)
        bpy.ops.papilla.bake(filepath=place("library.glb"), import_result=True)
        tags = tags_of(place("library.glb"))
        self.assertEqual(tags["Nappa leather, fine"]["stiffness"], 760)
        imported = [m for m in bpy.data.materials if m.name.startswith("Nappa") and not m.papilla_material.library]
        self.assertEqual(len(imported), 1)
        self.assertEqual(addon.tag_store.read(imported[0]), tags["Nappa leather, fine"])

    def test_names_that_are_patterns_mean_themselves(self):
        obj = suzanne()
        bpy.ops.papilla.assign_library(material=NAPPA)
        obj.active_material.name = "skin [a-z]* ?"
        bpy.ops.papilla.bake(filepath=place("odd.glb"))
        self.assertIn("skin [a-z]* ?", tags_of(place("odd.glb")))

    def test_tags_that_no_rule_is_for_stay_in_a_bake(self):
        obj = suzanne()
        bpy.ops.papilla.assign_library(material=NAPPA)
        other = bpy.data.materials.new("other")
        obj.data.materials.append(other)
        for face in list(obj.data.polygons)[:100]:
            face.material_index = 1
        tag = {"version": 1, "stiffness": 333.3}
        addon.tag_store.write(other, tag)
        bpy.ops.papilla.bake(filepath=place("both.glb"))
        self.assertEqual(tags_of(place("both.glb"))["other"], tag)

    def refuses(self, text, operator, **options):
        with self.assertRaises(RuntimeError) as caught:
            operator(**options)
        self.assertIn(text, str(caught.exception))

    def test_wrong_input_is_one_clear_error(self):
        ops = bpy.ops.papilla
        self.refuses("select a mesh first", ops.bake, filepath=place("refused.glb"))
        obj = suzanne()
        self.refuses("no material of the selected objects is of the library or has a photograph", ops.bake, filepath=place("refused.glb"))
        self.refuses("there is no such picture", ops.assign_grain, filepath=place("nowhere.png"))
        self.refuses("the active object has no material", ops.show_grain)
        bpy.ops.papilla.assign_library(material=NAPPA)
        self.refuses("it has no photograph", ops.show_grain)
        bpy.context.scene.unit_settings.scale_length = 0.001
        self.refuses("set Unit Scale to 1", ops.bake, filepath=place("refused.glb"))
        bpy.context.scene.unit_settings.scale_length = 1
        self.refuses("", ops.bake, filepath="/nowhere/none.glb")
        obj.active_material.papilla_material.picture = place("torn.png")
        with open(place("torn.png"), "w", encoding="utf-8") as file:
            file.write("no picture")
        self.refuses("torn.png", ops.bake, filepath=place("refused.glb"))
        self.assertFalse(os.path.exists(place("refused.glb")))
        obj.active_material.papilla_material.library = "leather/none"
        self.refuses("leather/none", ops.bake, filepath=place("refused.glb"))
