# SPDX-License-Identifier: GPL-3.0-or-later
"""What of the add-on needs no Blender: plain Python against the program and, where there is one, the module."""
import ast
import json
import math
import os
import pathlib
import re
import sys
import tempfile
import tomllib
import unittest
import zipfile

import numpy as np

ROOT = pathlib.Path(os.environ["PAPILLA_ROOT"])
ARCHIVE = pathlib.Path(os.environ["PAPILLA_ADDON"])
sys.path.insert(0, str(ARCHIVE.parent))  # the package as the archive has it

import papilla_blender
from papilla_blender import distortion, rules, schemas, tag, unwrap_options
from papilla_blender.engine import EngineError, Mesh, UnwrapSettings, find_engine, mesh_files

PROGRAM, MODULE = os.environ["PAPILLA_PROGRAM"], os.environ["PAPILLA_MODULE"]


def engine(choice="PROGRAM"):
    return find_engine(choice, PROGRAM, MODULE, os.environ["PAPILLA_MATERIAL_LIBRARY"])


def engines():
    return [engine("PROGRAM")] + ([engine("MODULE")] if MODULE else [])


def bump(size=12):
    """A bump of 80 mm on an even grid."""
    x, y = np.meshgrid(np.linspace(-40, 40, size), np.linspace(-40, 40, size))
    positions = np.column_stack([x.ravel(), y.ravel(), 15 * np.cos(x / 20).ravel() * np.cos(y / 25).ravel()])
    first = (np.arange(size - 1)[:, None] * size + np.arange(size - 1)).ravel()
    triangles = np.vstack([np.column_stack([first, first + 1, first + size + 1]), np.column_stack([first, first + size + 1, first + size])])
    return Mesh("bump", positions, triangles.astype(np.int32))


class PackageTest(unittest.TestCase):
    def test_the_archive_is_an_add_on_of_one_version_with_the_program_s_schemas(self):
        with zipfile.ZipFile(ARCHIVE) as archive:
            names = archive.namelist()
            manifest = tomllib.loads(archive.read("papilla_blender/blender_manifest.toml").decode())
            for path in ("apps/papilla/schema/materials.schema.json", "haptic/schema/haptic-material.schema.json"):
                self.assertEqual(archive.read("papilla_blender/schemas/" + pathlib.Path(path).name), (ROOT / path).read_bytes())
            self.assertEqual({entry.date_time for entry in archive.infolist()}, {(1980, 1, 1, 0, 0, 0)})
        self.assertEqual(names, sorted(names))
        self.assertFalse([n for n in names if not n.startswith("papilla_blender/")])
        version = re.search(r"project\(papilla VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertEqual(manifest["version"], version)
        self.assertEqual(".".join(map(str, papilla_blender.bl_info["version"])), version)
        self.assertEqual((manifest["id"], manifest["type"], manifest["schema_version"]), ("papilla_blender", "add-on", "1.0.0"))
        # Words that Blender's extension server asks of a manifest.
        self.assertLessEqual(len(manifest["tagline"]), 64)
        self.assertNotIn(manifest["tagline"][-1], ".!?")
        self.assertTrue(all(len(reason) <= 64 for reason in manifest["permissions"].values()))
        self.assertTrue(all(license.startswith("SPDX:") for license in manifest["license"]))

    def test_blender_is_imported_by_what_needs_it_only(self):
        self.assertNotIn("bpy", sys.modules)

    def test_no_name_is_used_that_newer_blenders_have_lost(self):
        gone = ("calc_normals(", "use_auto_smooth", "vertex_colors", "create_normals_split", "calc_normals_split",
                "free_normals_split", "bgl", "bevel_weight", "tessfaces", "layers_zmask", "blend_method", "specular_tint")
        for path in ROOT.glob("blender/papilla_blender/**/*.py"):
            text = path.read_text(encoding="utf-8")
            ast.parse(text, feature_version=(3, 10))  # the Python of Blender 3.4
            self.assertEqual([word for word in gone if re.search(rf"\b{re.escape(word)}", text)], [], path)


class TagTest(unittest.TestCase):
    TAG = {"version": 1, "stiffness": 900, "damping": 0.1 + 0.2, "height": {"scale": 1e-4, "uri": "data:image/png;base64,AA==", "sha256": "0" * 64}}

    def test_two_texts_give_the_tag_again_in_its_order(self):
        short, pictures = tag.pack(self.TAG)
        self.assertNotIn("AA==", short)
        self.assertEqual(json.dumps(tag.unpack(short, pictures)), json.dumps(self.TAG))

    def test_an_edit_leaves_the_original_and_all_else(self):
        which = tag.member_named("backing_depth")
        edited = tag.with_value(self.TAG, which, 2.5)
        self.assertEqual(edited, {**self.TAG, "version": 2, "backing": {"depth": 0.0025}})
        self.assertNotIn("backing", self.TAG)

    def test_numbers_of_single_precision_lose_the_digits_that_it_makes_up(self):
        self.assertEqual(tag.with_value(self.TAG, tag.member_named("damping"), float(np.float32(0.45)))["damping"], 0.45)

    def test_values_stay_within_the_limits_of_the_schema(self):
        for which in tag.MEMBERS:
            if which.kind != "number":
                continue
            low, high = which.limits
            for value in (-1e300, 1e300, low, high):
                inner = tag.value_of(tag.with_value(self.TAG, which, value), which)
                self.assertTrue(low - 1e-6 * abs(low) - 1e-12 <= inner <= high * (1 + 1e-6), (which.name, value, inner))

    def test_defaults_are_those_of_a_reader(self):
        bare = {"version": 1, "height": {"scale": 1e-4, "sha256": ""}}
        expected = {"stiffness": 500, "damping": 0, "static_friction": 0, "stribeck_velocity": 10, "height_width": 1000,
                    "force_model": "heightfield", "friction_model": "coulomb", "force_shading": False, "height_outward": "white"}
        for name, value in expected.items():
            self.assertEqual(tag.value_of(bare, tag.member_named(name)), value, name)
        self.assertEqual(tag.value_of({**bare, "dynamicFriction": 0.3}, tag.member_named("static_friction")), 0.3)

    def test_what_is_no_tag_is_refused(self):
        for wrong in (None, [], "text", {}, {"version": 3, "stiffness": 1}, {"version": True, "stiffness": 1}, {"version": 1}):
            with self.assertRaises(tag.TagError):
                tag.check(wrong)
        for short, pictures in (("", ""), ("{", ""), ("[]", ""), (json.dumps(self.TAG), '{"maps": "data:"}'), (json.dumps(self.TAG), "{")):
            with self.assertRaises(tag.TagError):
                tag.unpack(short, pictures)
        with self.assertRaises(tag.TagError):
            tag.from_custom_property("__import__('os')")

    def test_values_of_the_wrong_type_are_shown_as_defaults(self):
        wrong = {"version": 1, "stiffness": "soft", "staticFriction": True, "backing": 3, "height": {"metresPerUV": 4}, "forceModel": None}
        self.assertEqual(tag.value_of(wrong, tag.member_named("stiffness")), 500)
        for which in tag.MEMBERS:
            tag.value_of(wrong, which)

    def test_problems_are_told(self):
        self.assertEqual(tag.problems({"version": 1, "stiffness": 1, "staticFriction": 0.5, "dynamicFriction": 0.4}), [])
        self.assertIn("above static", tag.problems({"version": 1, "stiffness": 1, "staticFriction": 0.3, "dynamicFriction": 0.4})[0])
        self.assertIn("Bristles", tag.problems({"version": 1, "stiffness": 1, "frictionModel": {"name": "bristle", "stiffness": 2}})[0])


class OptionsTest(unittest.TestCase):
    def test_methods_and_choices_are_the_same_in_both_engines(self):
        found = engines()
        for ask in ("methods", "environment_maps", "efforts", "normalizations", "materials"):
            answers = [getattr(one, ask)() for one in found]
            self.assertGreater(len(answers[0]), 1)
            self.assertTrue(all(answer == answers[0] for answer in answers), ask)

    @unittest.skipUnless(MODULE, "no Python module")
    def test_each_method_is_offered_the_options_that_its_reader_takes(self):
        reader = engine("MODULE")
        methods = reader.methods()
        values = {"charts": "keep", "grain": "up", "solver": "cgal", "pins": [{"at": [0, 0, 0], "uv": [0, 0]}],
                  "iso_lines": [{"of": "u", "through": [[0, 0, 0], [1, 0, 0]]}], "eye": [0, 0, 1], "direction": [0, 0, 1],
                  "max_distortion": 4.1}
        told = schemas.schema("materials")["$defs"]["unwrap"]["properties"]
        for method in methods:
            if method == unwrap_options.ENVIRONMENT:
                continue
            offered = {o.name: o for o in unwrap_options.options_of(method, methods, reader.environment_maps())}
            for name, schema in told.items():
                if name in ("method", "grain_of"):
                    continue
                value = values.get(name, schema.get("default", schema.get("minimum", 1)))
                if name == "solver" and name in offered:
                    value = offered[name].choices[0]
                try:
                    reader._read_options({"method": method, name: value})
                    taken = True
                except EngineError as error:
                    self.assertRegex(str(error), "is of|makes its own charts|has no solver")
                    taken = False
                self.assertEqual(name in offered, taken, (method, name))

    def test_every_choice_of_every_method_is_taken_by_both_engines(self):
        mesh = bump(5)
        for one in engines():
            for option in unwrap_options.options_of("levy", one.methods(), one.environment_maps()):
                for choice in option.choices if option.name != "charts" else ():
                    with self.subTest(f"{one.label} {option.name} {choice}"):
                        try:
                            one.unwrap([mesh], UnwrapSettings("levy", {option.name: choice}))
                        except EngineError as error:
                            self.assertNotIn("must be one of", str(error))

    def test_words_of_the_command_line(self):
        given = {"phi": 0.25, "allow_flips": True, "feature_angle": 30.0, "iterations": 3, "grain": [0, 0, 1], "solver": "cgal",
                 "pins": [{"at": [1, 2, 3], "uv": [4, 5.5], "part": "lid"}],
                 "iso_lines": [{"of": "v", "through": [[0, 0, 0], [1, 0, 0]], "value": 2.0}]}
        self.assertEqual(unwrap_options.command_line(given), [
            "--phi=0.25", "--allow-flips", "--feature-angle=30.0", "--iterations=3", "--grain=0.0,0.0,1.0", "--solver=cgal",
            "--pin=1.0,2.0,3.0=4.0,5.5@lid", "--iso-line=v=2.0:0.0,0.0,0.0;1.0,0.0,0.0"])
        self.assertEqual(unwrap_options.command_line({"grain": {"edge": [1, 0, 0]}, "allow_flips": False}), ["--grain=edge:1.0,0.0,0.0"])

    @unittest.skipUnless(MODULE, "no Python module")
    def test_pins_lines_and_grain_mean_the_same_to_both(self):
        mesh = bump()
        given = ({"pins": [{"at": [-40, -40, 0], "uv": [0, 0]}, {"at": [40, 40, 0], "uv": [90, 95]}]},
                 {"iso_lines": [{"of": "v", "through": [[-40, 0, 0], [40, 0, 0]]}], "coupling": "orthogonal"},
                 {"grain": [1, 0, 0]}, {"grain": "longest"}, {"weights": "uniform", "border": "convex"})
        for options in given:
            with self.subTest(str(options)):
                program, module = (one.unwrap([mesh], UnwrapSettings("levy", options)) for one in engines())
                np.testing.assert_array_equal(program.uv[0], module.uv[0])
        plain = engine().unwrap([mesh], UnwrapSettings("levy"))
        self.assertFalse(np.array_equal(plain.uv[0], engine().unwrap([mesh], UnwrapSettings("levy", given[0])).uv[0]))


class EngineTest(unittest.TestCase):
    def test_every_method_gives_the_same_in_both(self):
        first, second = bump(), bump(7)
        second.name = "second  one"
        second.positions = second.positions + [200, 0, 0]
        for method in engine().methods():
            if method == "natural":
                continue
            with self.subTest(method):
                results = [one.unwrap([first, second], UnwrapSettings(method)) for one in engines()]
                for result in results:
                    self.assertEqual([uv.shape for uv in result.uv], [(len(m.triangles), 3, 2) for m in (first, second)])
                    for uv, expected in zip(result.uv, results[0].uv):
                        np.testing.assert_array_equal(uv, expected)
                    self.assertEqual((result.charts, result.methods, result.summary), (results[0].charts, results[0].methods, results[0].summary))

    def test_distortion_is_the_same_in_both_to_the_digits_of_the_table(self):
        mesh = bump()
        mesh.uv = mesh.positions[mesh.triangles][..., :2] * [1.5, 0.7]
        measured = [one.measure([mesh], "none") for one in engines()]
        for other in measured:
            np.testing.assert_allclose(other.symmetric_dirichlet, measured[0].symmetric_dirichlet, rtol=1e-8)
            np.testing.assert_allclose(other.stretch_l2, measured[0].stretch_l2, rtol=1e-8)
            np.testing.assert_array_equal(other.measured, measured[0].measured)
            self.assertEqual(other.summary, measured[0].summary)

    def test_a_part_without_a_map_keeps_the_others(self):
        broken = Mesh("torus of one chart", *torus())
        for one in engines():
            result = one.unwrap([bump(), broken], UnwrapSettings("lscm", {"charts": "keep"}))
            if result.failures[1]:
                self.assertIsNone(result.uv[1])
            self.assertIsNotNone(result.uv[0])

    def test_wrong_meshes_and_places_are_one_clear_error(self):
        with self.assertRaisesRegex(EngineError, "flat: it has no face"):
            Mesh("flat", np.zeros((3, 3)), np.zeros((0, 3), np.int32))
        with self.assertRaisesRegex(EngineError, "not finite"):
            Mesh("nan", np.full((3, 3), math.nan), np.array([[0, 1, 2]], np.int32))
        with self.assertRaisesRegex(EngineError, "no program"):
            find_engine("PROGRAM", "/nowhere/papilla")
        for one in engines():
            with self.assertRaises(EngineError):
                one.unwrap([bump()], UnwrapSettings("no such method"))
            with self.assertRaises(EngineError):
                one.bake(pathlib.Path("nowhere.glb"), pathlib.Path("nowhere.json"), pathlib.Path("out.glb"))

    def test_obj_files_keep_every_bit_of_names_and_numbers(self):
        mesh = bump(4)
        mesh.uv = np.random.default_rng(1).standard_normal((len(mesh.triangles), 3, 2)) * 1e3
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.obj"
            mesh.name = "two\nlines \u00fc"
            mesh_files.write_obj(path, [mesh, bump(3)])
            self.assertTrue(path.read_text(encoding="utf-8").startswith("o two lines \u00fc\n"))
            counts = [len(mesh.triangles), len(bump(3).triangles)]
            uv = mesh_files.read_obj_uv(path, counts)
            np.testing.assert_array_equal(uv[0], mesh.uv)
            self.assertIsNone(uv[1])
            with self.assertRaisesRegex(EngineError, "triangles"):
                mesh_files.read_obj_uv(path, [1])


def torus():
    i, j = np.meshgrid(np.arange(12), np.arange(8), indexing="ij")
    a, b = 2 * np.pi * i / 12, 2 * np.pi * j / 8
    positions = np.stack([(30 + 10 * np.cos(b)) * np.cos(a), (30 + 10 * np.cos(b)) * np.sin(a), 10 * np.sin(b)], -1).reshape(-1, 3)
    at = lambda p, q: (p % 12 * 8 + q % 8).ravel()
    corners = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
    return positions, np.vstack([np.column_stack(corners[:3]), np.column_stack([corners[0], *corners[2:]])]).astype(np.int32)


class RulesTest(unittest.TestCase):
    def test_materials_json_is_read_by_the_program(self):
        entry = next(e for e in engine().materials() if e.id == "leather/nappa-fine")
        given = [rules.MaterialRule("skin [1]*", library=entry.id, size_mm=(20, 20), depth_mm=0.1, unwrap="keep", tag=rules.tag_of_library(entry)),
                 rules.MaterialRule("plain", tag={"version": 1, "stiffness": 5})]
        told = rules.materials_json(given)
        self.assertEqual(list(told["materials"]), ["skin [1]*"])
        self.assertEqual(told["assign"], [{"gltf_material": "skin [[]1][*]", "material": "skin [1]*"}])
        self.assertEqual(told["materials"]["skin [1]*"]["backing"], {"stiffness": 1800.0, "depth_mm": 2.5})
        if not MODULE:
            return
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "m.json"
            path.write_text(json.dumps(told), encoding="utf-8")
            read = engine("MODULE")._papilla.read_materials(path, os.environ["PAPILLA_MATERIAL_LIBRARY"])
            self.assertEqual(read.materials["skin [1]*"].stiffness, entry.stiffness)

    def test_a_tag_without_backing_takes_that_of_the_library_away(self):
        rule = rules.MaterialRule("a", library="x/y", tag={"version": 1, "stiffness": 5})
        self.assertIsNone(rules.materials_json([rule])["materials"]["a"]["backing"])


class ColoursTest(unittest.TestCase):
    def test_the_scale_is_linear_between_its_ends(self):
        measure = distortion.measure_named("symmetric_dirichlet")
        colours = distortion.colour_bytes(np.array([3.0, 4.0, 4.5, 5.0, 1e300, math.nan]), measure, 5.0).tolist()
        self.assertEqual(colours, [[68, 1, 84], [68, 1, 84], [33, 144, 141], [253, 231, 37], [253, 231, 37], [220, 30, 30]])


if __name__ == "__main__":
    unittest.main()
