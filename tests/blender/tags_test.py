# SPDX-License-Identifier: GPL-3.0-or-later
"""Haptic tags through Blender: import, edit, export, play."""
import base64
import csv
import hashlib
import json
import os
import unittest

import bpy
import numpy as np

from shapes import PLAYER, WORK, addon, document, empty_scene, place, run, suzanne, tags_of, use_engine, with_document

COCKPIT = os.environ["PAPILLA_COCKPIT"]
EDITED = "soft skin #202020"


def import_gltf(path):
    empty_scene()
    bpy.ops.import_scene.gltf(filepath=path)


def export_gltf(path, **options):
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", **options)


def widest_place(material_name):
    """Middle and normal of the largest face with this material, in glTF's axes."""
    best = (0, None, None)
    for obj in bpy.context.scene.objects:
        if obj.type != "MESH":
            continue
        slots = [slot.material.name if slot.material else "" for slot in obj.material_slots]
        for face in obj.data.polygons:
            if slots and slots[face.material_index] == material_name and face.area > best[0]:
                world = obj.matrix_world
                best = (face.area, world @ face.center, (world.to_3x3() @ face.normal).normalized())
    _, centre, normal = best
    to_gltf = lambda v: np.array([v.x, v.z, -v.y])
    return to_gltf(centre), to_gltf(normal)


def write_stroke(path, centre, normal):
    """From 3 mm above to 1 mm below, then 6 mm along the surface; half a second."""
    along = np.cross(normal, [0.3, 0.5, 0.8])
    along /= np.linalg.norm(along)
    with open(path, "w", encoding="utf-8") as file:
        file.write("t,x,y,z\n")
        for t in np.linspace(0, 0.5, 501):
            depth = 0.003 - 0.004 * min(1, t / 0.2)
            p = centre + depth * normal + 0.006 * max(0, t - 0.2) / 0.3 * along
            file.write(f"{t:.4f},{p[0]:.9f},{p[1]:.9f},{p[2]:.9f}\n")


def forces(scene, stroke):
    """Of every tick; again when the machine paused the player, as it does under load."""
    record = place("record.csv")
    for _ in range(30):
        report = json.loads(run(PLAYER, scene, "-q", "--device", "sim", "--trajectory", stroke, "--record", record, "--json", "-"))
        if report["pauses"]["count"] == 0:
            break
    else:
        raise AssertionError("the machine paused the player in every run")
    with open(record, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return np.array([[row[f"force_{axis}"] for axis in "xyz"] for row in rows], float), report


def rms(vectors):
    return float(np.sqrt((np.asarray(vectors) ** 2).sum(axis=1).mean()))


class CockpitTest(unittest.TestCase):
    def setUp(self):
        import_gltf(COCKPIT)

    def test_an_untouched_file_keeps_every_tag_bit_by_bit(self):
        before = tags_of(COCKPIT)
        export_gltf(place("same.glb"))
        after = tags_of(place("same.glb"))
        self.assertGreater(len(before), 10)
        self.assertEqual({n: json.dumps(t) for n, t in before.items()}, {n: json.dumps(t) for n, t in after.items()})

    def test_height_maps_are_the_bytes_of_their_sum(self):
        export_gltf(place("same.glb"))
        found = 0
        for tag in tags_of(place("same.glb")).values():
            uri = tag.get("height", {}).get("uri", "")
            if uri:
                self.assertEqual(hashlib.sha256(base64.b64decode(uri.split(",")[1])).hexdigest(), tag["height"]["sha256"])
                found += 1
        self.assertGreaterEqual(found, 3)

    def test_the_members_of_papilla_stay_and_those_of_others_need_the_tick(self):
        export_gltf(place("same.glb"))
        material = next(m for m in document(place("same.glb"))["materials"] if m["name"] == EDITED)
        self.assertEqual(material["extras"]["papilla"], {"material": "soft skin", "original": "#202020"})
        self.assertNotIn("cad_colour", material["extras"])
        export_gltf(place("ticked.glb"), export_extras=True)
        material = next(m for m in document(place("ticked.glb"))["materials"] if m["name"] == EDITED)
        self.assertEqual(set(material["extras"]), {"cad_colour", "haptic", "papilla"})
        self.assertEqual(json.dumps(tags_of(place("ticked.glb"))[EDITED]), json.dumps(tags_of(COCKPIT)[EDITED]))
        # Copies of the tags at nodes would be those of before an edit.
        self.assertFalse(any("hapticMaterials" in n.get("extras", {}) for n in document(place("ticked.glb"))["nodes"]))

    def test_an_edited_tag_is_felt_as_the_edit_by_hand(self):
        group = bpy.data.materials[EDITED].papilla_material
        group.stiffness, group.dynamic_friction = 512.5, 0.21
        export_gltf(place("edited.glb"))

        def by_hand(told):
            tag = next(m for m in told["materials"] if m["name"] == EDITED)["extras"]["haptic"]
            tag["stiffness"], tag["dynamicFriction"] = 512.5, 0.21

        with_document(COCKPIT, by_hand, place("by_hand.glb"))
        self.assertEqual(tags_of(place("edited.glb")), tags_of(place("by_hand.glb")))
        stroke = place("stroke.csv")
        for name in (EDITED, "leather #2A2320", "hard grain #2B2B2E", "carpet #3C3C40", "metal #D9DCE0"):
            with self.subTest(name):
                write_stroke(stroke, *widest_place(name))
                expected, report = forces(place("by_hand.glb"), stroke)
                felt, own = forces(place("edited.glb"), stroke)
                self.assertGreater(report["contact_ticks"], 200)
                self.assertEqual(own["contact_ticks"], report["contact_ticks"])
                self.assertEqual(own["height_maps"]["missing"], 0)
                self.assertEqual(own["height_maps"]["loaded"], report["height_maps"]["loaded"])
                self.assert_same(name, felt, expected)
                original, _ = forces(COCKPIT, stroke)
                if name == EDITED:
                    self.assertGreater(rms(original - expected), 0.1 * rms(expected))  # the edit is felt
                else:
                    self.assert_same(name, felt, original)

    def assert_same(self, name, felt, expected):
        """But for what single precision takes of v, which Blender turns over twice: a slip on relief may come a tick sooner."""
        off = np.linalg.norm(felt - expected, axis=1) / rms(expected)
        print(f"\n  {name}: force {rms(expected):.4f} N, difference / force {np.median(off):.1e} median, {rms(felt - expected) / rms(expected):.1e} rms")
        self.assertLess(np.median(off), 1e-3)
        self.assertLess(rms(felt - expected), (0.02 if "height" in tags_of(COCKPIT)[name] else 1e-3) * rms(expected))


class TagTest(unittest.TestCase):
    """Tags of every member, at a small mesh."""

    WHOLE = {
        "version": 2, "stiffness": 400, "damping": 0.1, "staticFriction": 0.30000000000000004, "dynamicFriction": 0.2,
        "maps": {"uri": "data:image/png;base64,AAAA", "sha256": "0" * 64, "channels": {"r": {"quantity": "stiffness", "scale": 10.0}},
                 "wrap": ["clamp", "mirror"]},
        "height": {"scale": 1e-4, "sha256": "1" * 64, "uri": "data:image/png;base64,BBBB", "size": [1, 2], "wrap": ["repeat", "repeat"]},
        "backing": {"stiffness": 1800, "depth": 0.0025}, "forceShading": True,
        "roughness": {"hurst": 0.4, "rms": 4e-6, "wavelength_range": [2e-4, 1e-3], "overlay": True},
        "symmetry": {"group": "p1", "period": [[1e-3, 0.0], [0, 1e-3]]}, "other": [None, "\u00fc", {"deep": [1, 2.5]}],
    }

    def file_with(self, tag, name="plain.glb"):
        empty_scene()
        obj = suzanne()
        obj.data.materials.append(bpy.data.materials.new("skin"))
        export_gltf(place("bare.glb"))
        with_document(place("bare.glb"), lambda told: told["materials"][0].update(extras={"haptic": tag}), place(name))
        return place(name)

    def test_every_member_stays_in_its_place_also_through_a_blend_file(self):
        path = self.file_with(self.WHOLE)
        import_gltf(path)
        bpy.ops.wm.save_as_mainfile(filepath=place("tag.blend"))
        empty_scene()
        bpy.ops.wm.open_mainfile(filepath=place("tag.blend"))
        export_gltf(place("whole.glb"))
        self.assertEqual(json.dumps(tags_of(place("whole.glb"))["skin"]), json.dumps(self.WHOLE))

    def test_properties_show_units_and_limits_and_edit_one_member_only(self):
        import_gltf(self.file_with(self.WHOLE))
        material = bpy.data.materials["skin"]
        group = material.papilla_material
        self.assertAlmostEqual(group.backing_depth, 2.5, places=5)
        self.assertAlmostEqual(group.height_scale, 0.1, places=6)
        self.assertAlmostEqual(group.stribeck_velocity, 10, places=4)  # default, mm/s
        self.assertTrue(group.force_shading)
        self.assertEqual(group.friction_model, "coulomb")
        group.static_friction = group.static_friction  # what looks the same stays bit by bit
        self.assertEqual(addon.tag_store.read(material), self.WHOLE)
        group.stiffness = 1e30  # beyond the limit
        group.backing_depth, group.height_width, group.friction_model, group.force_shading = 3.1, 24, "bristle", False
        tag = addon.tag_store.read(material)
        expected = {**self.WHOLE, "stiffness": 1e7, "backing": {"stiffness": 1800, "depth": 0.0031}, "forceShading": False,
                    "frictionModel": {"name": "bristle"}, "height": {**self.WHOLE["height"], "metresPerUV": [0.024, 1]}}
        self.assertEqual(tag, expected)
        group.has_backing = False
        self.assertNotIn("backing", addon.tag_store.read(material))
        stiffness = group.bl_rna.properties["stiffness"]
        self.assertEqual((stiffness.hard_min, stiffness.hard_max), (0, 1e7))
        self.assertIn("N/m", stiffness.name)

    def test_a_backing_makes_a_tag_of_version_2(self):
        import_gltf(self.file_with({"version": 1, "stiffness": 900}))
        material = bpy.data.materials["skin"]
        material.papilla_material.has_backing = True
        self.assertEqual(addon.tag_store.read(material), {"version": 2, "stiffness": 900, "backing": {"stiffness": 1800.0, "depth": 0.002}})

    def test_what_was_imported_without_the_add_on_is_read_from_custom_properties(self):
        path = self.file_with(self.WHOLE)
        empty_scene()
        bpy.ops.preferences.addon_disable(module="papilla_blender")
        bpy.ops.import_scene.gltf(filepath=path)
        kept = bpy.data.materials["skin"]
        self.assertIn("haptic", kept)
        bpy.ops.preferences.addon_enable(module="papilla_blender")
        export_gltf(place("adopted.glb"))
        tag = tags_of(place("adopted.glb"))["skin"]
        self.assertEqual(tag, self.WHOLE)
        self.assertIs(tag["forceShading"], True)
        self.assertIs(tag["roughness"]["overlay"], True)
        kept.papilla_material.stiffness = 410
        self.assertNotIn("haptic", kept)
        self.assertEqual(addon.tag_store.read(kept), {**self.WHOLE, "stiffness": 410.0})

    def test_no_tag_is_no_tag(self):
        import_gltf(self.file_with({"version": 9, "stiffness": 900}))
        self.assertFalse(addon.tag_store.has_tag(bpy.data.materials["skin"]))
        export_gltf(place("none.glb"))
        self.assertEqual(tags_of(place("none.glb")), {})

    def test_a_scribbled_tag_is_not_written(self):
        import_gltf(self.file_with(self.WHOLE))
        bpy.data.materials["skin"].papilla_material.tag = "{"
        with self.assertRaises(addon.tag.TagError):
            addon.tag_store.read(bpy.data.materials["skin"])
        export_gltf(place("none.glb"))
        self.assertEqual(tags_of(place("none.glb")), {})

    def test_pictures_beside_the_file_come_along(self):
        beside = {"version": 1, "stiffness": 900, "height": {"scale": 1e-4, "sha256": "0" * 64, "uri": "relief%201.png"}}
        with open(place("relief 1.png"), "wb") as file:
            file.write(b"PNG!")
        import_gltf(self.file_with(beside))
        height = addon.tag_store.read(bpy.data.materials["skin"])["height"]
        self.assertEqual(height["uri"], "data:image/png;base64," + base64.b64encode(b"PNG!").decode())
        for uri in ("../outside.png", "/etc/hostname"):
            import_gltf(self.file_with({**beside, "height": {**beside["height"], "uri": uri}}))
            self.assertFalse(addon.tag_store.has_tag(bpy.data.materials["skin"]))

    def test_operators_make_and_remove_tags(self):
        empty_scene()
        obj = suzanne()
        self.assertFalse(bpy.ops.papilla.new_tag.poll())
        obj.data.materials.append(bpy.data.materials.new("skin"))
        bpy.ops.papilla.new_tag()
        self.assertEqual(addon.tag_store.read(obj.active_material), {"version": 1, "stiffness": 500.0})
        bpy.ops.papilla.remove_tag()
        self.assertFalse(addon.tag_store.has_tag(obj.active_material))
        self.assertFalse(bpy.ops.papilla.remove_tag.poll())
