# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrapping in Blender against the program on files that Blender itself writes."""
import json
import math
import unittest

import bmesh
import bpy
import numpy as np

from shapes import MODULE, PROGRAM, addon, empty_scene, engines, place, run, settings, suzanne, use_engine

METHODS = ("lscm", "maillot", "best")
CLOSE = ("triangles", "flipped", "stretch_l2", "symmetric_dirichlet.mean", "seam_length_mm")


def uv_of(obj, layer="papilla"):
    data = obj.data.uv_layers[layer].data
    values = np.empty(2 * len(data), np.float32)
    data.foreach_get("uv", values)
    return values.reshape(-1, 2)


def exported(name="unwrapped.glb"):
    bpy.ops.export_scene.gltf(filepath=place(name), export_format="GLB", use_selection=True)
    return place(name)


def keep_only(obj, layer="papilla"):
    """The layer as glTF's TEXCOORD_0."""
    for other in [l.name for l in obj.data.uv_layers if l.name != layer]:
        obj.data.uv_layers.remove(obj.data.uv_layers[other])


def program_measure(path, *words):
    return json.loads(run(PROGRAM, "measure", path, "--json", "-", *words))


def flat(told):
    return addon.engine.base.summary_of(told)


def shown(text):
    """The numbers of the panel's report."""
    return [line.name for line in settings().report if text in line.name]


class UnwrapTest(unittest.TestCase):
    def setUp(self):
        empty_scene()
        use_engine("PROGRAM")
        settings().method, settings().uv_space, settings().layer = "auto", "MM", "papilla"
        settings().gutter_mm = 0
        for option in settings().options:
            option.use = False

    def assert_close(self, got, expected, relative, but=()):
        for key, value in expected.items():
            if key not in but:
                self.assertTrue(math.isclose(got[key], value, rel_tol=relative, abs_tol=1e-9), f"{key}: {got[key]} and {value}")

    def test_measure_is_the_program_s_for_three_methods(self):
        for engine in engines():
            for method in METHODS:
                with self.subTest(f"{engine} {method}"):
                    empty_scene()
                    use_engine(engine)
                    obj = suzanne()
                    # The program on the mesh as Blender writes it.
                    settings().method = method
                    whole = json.loads(run(PROGRAM, "unwrap", exported("plain.glb"), "--keep-sides", "--method", method, "-o", place("own.obj"), "--json", "-"))
                    self.assertEqual(bpy.ops.papilla.unwrap(), {"FINISHED"})
                    surface = addon.meshes.Surface(obj, bpy.context.scene)
                    mine = addon.preferences.current_engine(bpy.context).measure([surface.mesh(surface.uv("papilla"))], "scene").summary
                    keep_only(obj)
                    # What Blender writes of it, measured by the program.
                    self.assert_close(mine, flat(program_measure(exported())), 1e-4, but=("overlap_area_fraction",))
                    # The exporter numbers vertices its own way, from where on iterations end elsewhere within their tolerance.
                    self.assertEqual(mine["charts"], whole["charts"])
                    self.assert_close(mine, {k: v for k, v in flat(whole["distortion"]).items() if k in CLOSE}, 1e-3)
                    print(f"\n  {engine} {method}: symmetric Dirichlet {mine['symmetric_dirichlet.mean']:.6f}, "
                          f"the program {whole['distortion']['symmetric_dirichlet']['mean']:.6f}")
                    self.assertEqual(mine["flipped"], 0)

    @unittest.skipUnless(MODULE, "no Python module")
    def test_module_and_program_give_the_same_coordinates(self):
        for method in METHODS:
            with self.subTest(method):
                written = []
                for engine in engines():
                    empty_scene()
                    use_engine(engine)
                    obj = suzanne()
                    settings().method = method
                    bpy.ops.papilla.unwrap()
                    written.append(uv_of(obj))
                np.testing.assert_array_equal(*written)

    def test_a_unit_of_uv_is_a_millimetre(self):
        bpy.ops.mesh.primitive_plane_add(size=0.1)
        bpy.context.object.scale = (2, 1, 1)
        bpy.ops.papilla.unwrap()
        span = np.ptp(uv_of(bpy.context.object), axis=0)
        np.testing.assert_allclose(sorted(span), (100, 200), rtol=1e-5)
        bpy.context.scene.unit_settings.scale_length = 0.001  # now a tenth of a millimetre
        bpy.ops.papilla.unwrap()
        np.testing.assert_allclose(sorted(np.ptp(uv_of(bpy.context.object), axis=0)), (0.1, 0.2), rtol=1e-5)

    def test_an_atlas_lies_within_0_and_1_and_keeps_its_scale(self):
        obj = suzanne()
        bpy.ops.papilla.unwrap()
        in_mm, before = uv_of(obj).astype(float), settings().report[2].name
        empty_scene()
        use_engine("PROGRAM")
        obj = suzanne()
        settings().uv_space = "ATLAS"
        bpy.ops.papilla.unwrap()
        uv = uv_of(obj).astype(float)
        self.assertGreaterEqual(uv.min(), 0)
        self.assertAlmostEqual(uv.max(), 1, places=6)
        unit = obj.data["papilla_mm_per_uv"]["papilla"]
        np.testing.assert_allclose(uv * unit, in_mm - in_mm.min(axis=0), atol=1e-4 * unit)
        settings().normalize = "none"  # counts uv as millimetres: the unit is known
        bpy.ops.papilla.measure()
        self.assertAlmostEqual(float(settings().report[1].name.split()[2].rstrip(",")), float(before.split()[2].rstrip(",")), places=3)

    def test_faces_with_seams_are_split_and_all_else_stays(self):
        obj = suzanne()
        first = {tuple(obj.data.vertices[v].index for v in f.vertices): [tuple(obj.data.uv_layers[0].data[l].uv) for l in f.loop_indices]
                 for f in obj.data.polygons}
        vertices = len(obj.data.vertices)
        settings().method = "triplanar"
        bpy.ops.papilla.unwrap()
        self.assertEqual(len(obj.data.vertices), vertices)
        split = int(shown("split along seams")[0].split()[0])
        self.assertGreater(split, 5)
        self.assertEqual(len(obj.data.polygons), len(first) + split)
        self.assertEqual(obj.data.uv_layers.keys(), ["UVMap", "papilla"])
        whole = [f for f in obj.data.polygons if tuple(f.vertices) in first]
        self.assertGreater(len(whole), 300)
        for face in whole:
            self.assertEqual([tuple(obj.data.uv_layers[0].data[l].uv) for l in face.loop_indices], first[tuple(face.vertices)])
        mine = program_of(obj)
        keep_only(obj)
        self.assert_close(mine, flat(program_measure(exported())), 1e-4, but=("overlap_area_fraction",))

    def test_polygons_of_many_corners_are_split(self):
        bpy.ops.mesh.primitive_cylinder_add(vertices=17, radius=0.05, depth=0.1)
        obj = bpy.context.object
        bm = bmesh.new()
        bm.from_mesh(obj.data)
        for face in bm.faces:  # no flat cap: charts may end within it
            if len(face.verts) == 17:
                for vertex in face.verts:
                    vertex.co.z += 0.04 * math.cos(3 * math.atan2(vertex.co.y, vertex.co.x))
        bm.to_mesh(obj.data)
        bm.free()
        settings().method = "triplanar"
        bpy.ops.papilla.unwrap()
        mine = program_of(obj)
        keep_only(obj)
        self.assert_close(mine, flat(program_measure(exported())), 1e-3, but=("overlap_area_fraction",))

    def test_mirrored_objects_are_mapped_unmirrored(self):
        obj = suzanne()
        obj.scale = (-1, 1, 1)
        bpy.context.view_layer.update()
        bpy.ops.papilla.unwrap()
        keep_only(obj)
        told = program_measure(exported())
        # glTF keeps the mesh as it is and the mirror in the node: there every chart has to be mirrored once more.
        self.assertEqual((told["flipped"], told["mirrored_charts"]), (0, told["charts"]))

    def test_several_objects_share_an_atlas(self):
        first, second = suzanne(), suzanne(0.1)
        first.select_set(True)
        bpy.ops.papilla.unwrap()
        boxes = [(uv.min(axis=0), uv.max(axis=0)) for uv in (uv_of(first), uv_of(second))]
        settings().normalize = "none"
        bpy.ops.papilla.measure()
        self.assertEqual(settings().report[0].name.split()[0], "1936")
        self.assertTrue(all(np.isfinite(b).all() for b in boxes))

    def test_linked_meshes_are_mapped_once(self):
        first = suzanne()
        second = bpy.data.objects.new("copy", first.data)
        bpy.context.collection.objects.link(second)
        second.select_set(True)
        bpy.ops.papilla.unwrap()
        self.assertEqual(settings().report[1].name.split()[0], "968")

    def test_options_reach_the_engine(self):
        for engine in engines():
            with self.subTest(engine):
                empty_scene()
                use_engine(engine)
                suzanne()
                settings().method = "maillot"
                option = {item.name: item for item in settings().options}
                self.assertEqual(option["solver"].choice, "gauss-newton")
                option["phi"].use, option["phi"].number = True, 0.05
                bpy.ops.papilla.unwrap()
                with_phi = settings().report[2].name
                own = json.loads(run(PROGRAM, "unwrap", exported("plain.glb"), "--keep-sides", "--method", "maillot", "--phi", "0.05", "-o", place("own.obj"), "--json", "-"))
                self.assertIn(f"{own['distortion']['symmetric_dirichlet']['mean']:.3f}", with_phi)
                option = {item.name: item for item in settings().options}
                option["phi"].use = False
                bpy.ops.papilla.unwrap()
                self.assertNotEqual(settings().report[2].name, with_phi)

    def test_charts_of_the_mesh_s_own_uv(self):
        for engine in engines():
            empty_scene()
            use_engine(engine)
            suzanne()
            settings().method = "lscm"
            option = {item.name: item for item in settings().options}["charts"]
            option.use, option.choice = True, "uv"
            bpy.ops.papilla.unwrap()
            with self.subTest(engine):
                self.assertIn("lscm: ", settings().report[0].name)

    def refuses(self, text, operator=None):
        with self.assertRaises(RuntimeError) as caught:
            (operator or bpy.ops.papilla.unwrap)()
        self.assertIn(text, str(caught.exception))

    def test_wrong_input_is_one_clear_error(self):
        self.refuses("select a mesh first")
        obj = suzanne()
        bpy.ops.object.mode_set(mode="EDIT")
        self.refuses("leave edit mode first")
        bpy.ops.object.mode_set(mode="OBJECT")
        settings().layer = ""
        self.refuses("the uv layer has no name")
        settings().layer = "papilla"
        self.refuses("Suzanne: it has no uv layer 'papilla'", bpy.ops.papilla.measure)
        self.assertEqual(obj.data.uv_layers.keys(), ["UVMap"])
        obj.data.vertices[3].co.x = math.nan
        self.refuses("Suzanne: a position is not finite")
        empty_scene()
        mesh = bpy.data.meshes.new("none")
        bare = bpy.data.objects.new("bare", mesh)
        bpy.context.collection.objects.link(bare)
        bare.select_set(True)
        self.refuses("bare: it has no face")

    def test_what_the_library_refuses_is_told_in_its_words(self):
        for engine in engines():
            with self.subTest(engine):
                empty_scene()
                use_engine(engine)
                suzanne()
                settings().method = "natural"
                self.refuses("the mesh has no CAD parameters")
                settings().method = "maillot"
                option = {item.name: item for item in settings().options}
                option["phi"].use, option["phi"].number = True, 7
                self.refuses("phi")
                option["phi"].use = False
                option["grain"].use, option["grain"].text = True, "[1, 2"
                self.refuses("grain: '[1, 2' is no JSON")

    def test_no_engine_is_told(self):
        suzanne()
        chosen = bpy.context.preferences.addons["papilla_blender"].preferences
        chosen.program = "/nowhere/papilla"
        self.refuses("there is no program '/nowhere/papilla'")
        chosen.program = "/bin/false"
        self.refuses("/bin/false")

    def test_esc_ends_a_call_and_changes_nothing(self):
        obj = suzanne()
        for engine in engines():
            with self.subTest(engine):
                use_engine(engine)
                operator = addon.job.Job
                surface = addon.meshes.Surface(obj, bpy.context.scene)
                fine = subdivided(surface.mesh(), 4)
                found = addon.preferences.current_engine(bpy.context)
                wanted = addon.engine.UnwrapSettings("best", effort="best")
                job = operator(lambda progress: found.unwrap([fine], wanted, progress))
                while not job.stage and job.is_running():
                    pass
                job.cancel()
                with self.assertRaises(addon.engine.Cancelled):
                    job.result()
        self.assertEqual(obj.data.uv_layers.keys(), ["UVMap"])


def subdivided(mesh, times):
    """Every triangle as four, `times` times: work for a while."""
    positions, triangles = mesh.positions, mesh.triangles
    for _ in range(times):
        corners = positions[triangles]
        middles = (corners + np.roll(corners, -1, axis=1)) / 2
        points = np.concatenate([corners, middles], axis=1).reshape(-1, 3)
        at = 6 * np.arange(len(triangles))[:, None, None] + np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
        positions, triangles = np.unique(points, axis=0, return_inverse=True)
        triangles = triangles.reshape(-1)[at.reshape(-1, 3)].astype(np.int32)
    return addon.engine.Mesh("fine", positions, triangles)


def program_of(obj):
    surface = addon.meshes.Surface(obj, bpy.context.scene)
    return addon.preferences.current_engine(bpy.context).measure([surface.mesh(surface.uv("papilla"))], "scene").summary
