# SPDX-License-Identifier: GPL-3.0-or-later
import json
import os
import pathlib
import tempfile

import bpy
import numpy as np
from bpy_extras.io_utils import ExportHelper, ImportHelper

from . import materials, meshes, tag_store
from . import tag as tags
from .distortion import any_per_face, legend, value_per_face
from .engine import EngineError, UnwrapSettings
from .job import LongOperator
from .preferences import current_engine
from .properties import fill_options, say
from .rules import materials_json

DISTORTION = "papilla distortion"


def selected_meshes(context):
    """@throws EngineError when no mesh is selected."""
    if context.mode != "OBJECT":
        raise EngineError("leave edit mode first")
    found = meshes.mesh_objects(context.selected_objects)
    if not found:
        raise EngineError("select a mesh first")
    return found


def surfaces_of(objects, context):
    surfaces = [meshes.Surface(obj, context.scene) for obj in objects]
    for surface in surfaces:
        if not len(surface.triangles):
            raise EngineError(f"{surface.object.name}: it has no face")
    return surfaces


def summary_lines(summary):
    return [
        f"{summary['triangles']} triangles in {summary['charts']} charts, {summary['flipped']} flipped",
        f"symmetric Dirichlet {summary['symmetric_dirichlet.mean']:.4f}, at most {summary['symmetric_dirichlet.max']:.4g}",
        f"stretch {summary['stretch_l2']:.4f}, at most {summary['stretch_linf']:.4g}",
        f"angle error {summary['angle_error_deg.mean']:.3g}\u00b0, at most {summary['angle_error_deg.max']:.3g}\u00b0",
        f"seams {summary['seam_length_mm']:.1f} mm, overlap {100 * summary['overlap_area_fraction']:.3g} %",
    ]


class PAPILLA_OT_unwrap(LongOperator, bpy.types.Operator):
    """Give the selected meshes charts and texture coordinates in a layer of their own"""

    bl_idname = "papilla.unwrap"
    bl_label = "Unwrap"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context):
        settings = context.window_manager.papilla
        if not settings.layer:
            raise EngineError("the uv layer has no name")
        engine = current_engine(context)
        self._surfaces = surfaces_of(selected_meshes(context), context)
        wanted = UnwrapSettings(settings.method, settings.given_options(), settings.effort,
                                settings.gutter_mm if settings.gutter_mm > 0 else None)
        given = [surface.mesh(self._own_uv(surface, wanted)) for surface in self._surfaces]
        return lambda progress: engine.unwrap(given, wanted, progress)

    def _own_uv(self, surface, wanted):
        """Charts that are to be those of the mesh's own uv need them."""
        if wanted.options.get("charts") != "uv":
            return None
        layer = surface.object.data.uv_layers.active
        if layer is None:
            raise EngineError(f"{surface.object.name}: charts: it has no uv layer")
        return surface.uv(layer.name)

    def finish(self, context, result):
        settings = context.window_manager.papilla
        for surface in self._surfaces:
            surface.check_unchanged()
        mapped = [uv for uv in result.uv if uv is not None]
        low = np.min([uv.min(axis=(0, 1)) for uv in mapped], axis=0)
        high = np.max([uv.max(axis=(0, 1)) for uv in mapped], axis=0)
        unit = float(max(high - low)) if settings.uv_space == "ATLAS" else 1.0
        split = sum(meshes.write_uv(surface, uv - low if unit != 1.0 else uv, settings.layer, unit)
                    for surface, uv in zip(self._surfaces, result.uv) if uv is not None)
        lines = [f"{', '.join(sorted(set(result.methods)))}: {result.charts} charts", *summary_lines(result.summary)]
        if unit != 1.0:
            lines.append(f"a unit of uv is {unit:.6g} mm")
        if split:
            lines.append(f"{split} faces split along seams")
        say(settings, lines)
        for surface, failure in zip(self._surfaces, result.failures):
            if failure:
                self.report({"WARNING"}, f"{surface.object.name}: {failure}")
        self.report({"INFO"}, "; ".join(lines[:3]))


class PAPILLA_OT_measure(LongOperator, bpy.types.Operator):
    """Colour the selected meshes by the distortion of their texture coordinates, face by face"""

    bl_idname = "papilla.measure"
    bl_label = "Show Distortion"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context):
        settings = context.window_manager.papilla
        engine = current_engine(context)
        if settings.worst <= settings.chosen_measure().least:
            raise EngineError(f"the scale must end above {settings.chosen_measure().least:g}, the value of an isometry")
        self._surfaces = surfaces_of(selected_meshes(context), context)
        given = [surface.mesh(surface.uv(settings.layer)) for surface in self._surfaces]
        normalize = settings.normalize
        return lambda progress: engine.measure(given, normalize, progress)

    def finish(self, context, result):
        settings = context.window_manager.papilla
        measure, worst = settings.chosen_measure(), settings.worst
        for surface in self._surfaces:
            surface.check_unchanged()
        values, begin = result.values(measure.name), 0
        for surface in self._surfaces:
            own = slice(begin, begin + len(surface.triangles))
            begin = own.stop
            count = len(surface.object.data.polygons)
            of_faces = value_per_face(values[own], result.area_mm2[own], surface.faces, count)
            wrong = any_per_face(result.flipped[own] | ~result.measured[own], surface.faces, count)
            meshes.write_distortion(surface, of_faces, wrong, measure, worst, DISTORTION)
        settings.legend.clear()
        for value, colour in legend(measure, worst):
            step = settings.legend.add()
            step.name, step.color = f"{value:.4g}", [c / 255 for c in colour]
        lines = summary_lines(result.summary)
        say(settings, lines)
        self.report({"INFO"}, "; ".join(lines[:3]))


def _library_items(self, context):
    try:
        entries = current_engine(context).materials()
    except EngineError:
        entries = []
    _library_items.shown = [(e.id, f"{e.name} ({e.id.split('/')[0]})", ", ".join(e.uses)) for e in entries]
    return _library_items.shown or [("", "no library", "")]


class PAPILLA_OT_assign_library(bpy.types.Operator):
    """Give the selected objects a material of the library, with its look and its haptic tag"""

    bl_idname = "papilla.assign_library"
    bl_label = "Material of the Library"
    bl_options = {"REGISTER", "UNDO"}
    bl_property = "material"

    material: bpy.props.EnumProperty(name="Material", items=_library_items)

    def invoke(self, context, event):
        context.window_manager.invoke_search_popup(self)
        return {"FINISHED"}

    def execute(self, context):
        try:
            objects = selected_meshes(context)
            entry = next((e for e in current_engine(context).materials() if e.id == self.material), None)
            if entry is None:
                raise EngineError(f"the library has no material '{self.material}'")
        except EngineError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        materials.assign(objects, materials.material_of_library(entry))
        return {"FINISHED"}


class PAPILLA_OT_assign_grain(ImportHelper, bpy.types.Operator):
    """Give the active object's material a photograph of grain that shows so many millimetres"""

    bl_idname = "papilla.assign_grain"
    bl_label = "Grain from Photograph"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: bpy.props.StringProperty(default="*.png;*.jpg;*.jpeg;*.tif;*.tiff;*.exr;*.webp;*.bmp", options={"HIDDEN"})
    size_mm: bpy.props.FloatVectorProperty(name="Shows [mm]", size=2, min=0.001, max=100000, default=(40, 40),
                                           description="Width and height in millimetres that the photograph shows")
    depth_mm: bpy.props.FloatProperty(name="Depth [mm]", min=0, max=100, default=0, precision=3,
                                      description="Of the relief, peak to valley; 0: the program's own")

    def execute(self, context):
        settings = context.window_manager.papilla
        try:
            objects = selected_meshes(context)
            if not os.path.isfile(self.filepath):
                raise EngineError(f"{self.filepath}: there is no such picture")
            material = objects[0].active_material
            if material is None:
                material = bpy.data.materials.new(pathlib.Path(self.filepath).stem)
                tag_store.write(material, tags.new_tag())
            elif not tag_store.has_tag(material):
                tag_store.write(material, tags.new_tag())
            group = material.papilla_material
            group.picture, group.size_mm, group.depth_mm = self.filepath, self.size_mm, self.depth_mm
            materials.assign(objects, material)
            if objects[0].data.uv_layers.get(settings.layer):
                materials.show_picture(material, objects[0].data, settings.layer)
            else:
                self.report({"INFO"}, f"no uv layer '{settings.layer}' yet: unwrap, then lay the photograph on it")
        except (EngineError, RuntimeError, tags.TagError) as error:
            self.report({"ERROR"}, str(error).strip())
            return {"CANCELLED"}
        return {"FINISHED"}


class PAPILLA_OT_show_grain(bpy.types.Operator):
    """Lay the material's photograph on the uv layer, at its scale"""

    bl_idname = "papilla.show_grain"
    bl_label = "Lay on UV"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        settings, obj = context.window_manager.papilla, context.active_object
        try:
            if obj is None or obj.type != "MESH" or obj.active_material is None:
                raise EngineError("the active object has no material")
            group = obj.active_material.papilla_material
            if not group.picture:
                raise EngineError(f"{obj.active_material.name}: it has no photograph")
            if min(group.size_mm) <= 0:
                raise EngineError(f"{obj.active_material.name}: how many millimetres the photograph shows is not said")
            if not obj.data.uv_layers.get(settings.layer):
                raise EngineError(f"{obj.name}: it has no uv layer '{settings.layer}'")
            materials.show_picture(obj.active_material, obj.data, settings.layer)
        except (EngineError, RuntimeError) as error:
            self.report({"ERROR"}, str(error).strip())
            return {"CANCELLED"}
        return {"FINISHED"}


class PAPILLA_OT_bake(LongOperator, ExportHelper, bpy.types.Operator):
    """Write a GLB with relief and haptic tags: what the selected objects' materials say, baked by papilla"""

    bl_idname = "papilla.bake"
    bl_label = "Bake to GLB"
    filename_ext = ".glb"

    filter_glob: bpy.props.StringProperty(default="*.glb", options={"HIDDEN"})
    import_result: bpy.props.BoolProperty(name="Import the Result", default=False)

    def invoke(self, context, event):
        return ExportHelper.invoke(self, context, event)

    def execute(self, context):
        """After the file browser; with a window the work goes on beside it."""
        if bpy.app.background:
            return LongOperator.execute(self, context)
        return LongOperator.invoke(self, context, None)

    def prepare(self, context):
        engine = current_engine(context)
        objects = selected_meshes(context)
        if abs(context.scene.unit_settings.scale_length - 1) > 1e-6:
            raise EngineError(f"glTF takes a unit of Blender for a metre: set Unit Scale to 1, it is {context.scene.unit_settings.scale_length:g}")
        try:
            rules = materials_json(materials.rules_of(context.selected_objects))
        except tags.TagError as error:
            raise EngineError(str(error)) from error
        if not rules["materials"]:
            raise EngineError("no material of the selected objects is of the library or has a photograph")
        folder = tempfile.TemporaryDirectory(prefix="papilla-")
        scene, told = pathlib.Path(folder.name) / "scene.glb", pathlib.Path(folder.name) / "materials.json"
        told.write_text(json.dumps(rules), encoding="utf-8")
        with meshes.first_in(objects, context.window_manager.papilla.layer):
            export_selected(str(scene))

        def work(progress):
            with folder:
                return engine.bake(scene, told, pathlib.Path(self.filepath), progress)

        return work

    def finish(self, context, result):
        for note in result.notes:
            self.report({"WARNING"}, note)
        say(context.window_manager.papilla, [f"{result.surfaces} surfaces with relief", os.path.basename(self.filepath), *result.notes])
        if self.import_result:
            bpy.ops.import_scene.gltf(filepath=self.filepath)
        self.report({"INFO"}, f"{self.filepath}: {result.surfaces} surfaces with relief")


def export_selected(path):
    """@throws EngineError where Blender's glTF add-on is off or fails."""
    try:
        bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", use_selection=True, export_apply=True)
    except (AttributeError, RuntimeError) as error:
        raise EngineError(f"Blender's glTF export: {str(error).strip()}") from error


class PAPILLA_OT_new_tag(bpy.types.Operator):
    """Give the active material a haptic tag"""

    bl_idname = "papilla.new_tag"
    bl_label = "New Haptic Tag"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return _active_material(context) is not None

    def execute(self, context):
        tag_store.write(_active_material(context), tags.new_tag())
        return {"FINISHED"}


class PAPILLA_OT_remove_tag(bpy.types.Operator):
    """Take the haptic tag, with its pictures, from the active material"""

    bl_idname = "papilla.remove_tag"
    bl_label = "Remove Haptic Tag"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        material = _active_material(context)
        return material is not None and tag_store.has_tag(material)

    def execute(self, context):
        tag_store.write(_active_material(context), None)
        return {"FINISHED"}


class PAPILLA_OT_refresh(bpy.types.Operator):
    """Ask the engine again what methods and options there are"""

    bl_idname = "papilla.refresh"
    bl_label = "List the Options"

    def execute(self, context):
        fill_options(context.window_manager.papilla, context)
        return {"FINISHED"}


def _active_material(context):
    return context.active_object.active_material if context.active_object else None


CLASSES = (PAPILLA_OT_unwrap, PAPILLA_OT_measure, PAPILLA_OT_assign_library, PAPILLA_OT_assign_grain, PAPILLA_OT_show_grain,
           PAPILLA_OT_bake, PAPILLA_OT_new_tag, PAPILLA_OT_remove_tag, PAPILLA_OT_refresh)
