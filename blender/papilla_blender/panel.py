# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel of the 3D viewport's sidebar."""
import bpy

from . import tag_store
from . import tag as tags
from .engine import EngineError
from .preferences import current_engine


class _Sidebar:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Papilla"


class PAPILLA_PT_main(_Sidebar, bpy.types.Panel):
    bl_idname = "PAPILLA_PT_main"
    bl_label = "Papilla"

    def draw(self, context):
        layout = self.layout
        try:
            layout.label(text=current_engine(context).label)
        except EngineError as error:
            layout.label(text=str(error), icon="ERROR")
        lines = context.window_manager.papilla.report
        if lines:
            box = layout.box().column(align=True)
            for line in lines:
                box.label(text=line.name)


class _Section(_Sidebar):
    bl_parent_id = "PAPILLA_PT_main"
    bl_options = {"DEFAULT_CLOSED"}


class PAPILLA_PT_unwrap(_Section, bpy.types.Panel):
    bl_label = "Unwrap"
    bl_options = set()

    def draw(self, context):
        layout, settings = self.layout, context.window_manager.papilla
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("method", "effort", "uv_space", "layer", "gutter_mm"):
            layout.prop(settings, name)
        if settings.options:
            box = layout.box().column(align=True)
            for option in settings.options:
                _draw_option(box, option)
        else:
            layout.operator("papilla.refresh", icon="FILE_REFRESH")
        layout.operator("papilla.unwrap", icon="UV")


def _draw_option(column, option):
    row = column.row(align=True)
    row.use_property_split = False
    row.prop(option, "use", text=option.name.replace("_", " "))
    value = row.row()
    value.enabled = option.use
    value.prop(option, option.kind, text="")
    if option.use:
        column.label(text=option.description, icon="INFO")


class PAPILLA_PT_distortion(_Section, bpy.types.Panel):
    bl_label = "Distortion"

    def draw(self, context):
        layout, settings = self.layout, context.window_manager.papilla
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("measure", "layer", "normalize", "worst"):
            layout.prop(settings, name)
        layout.operator("papilla.measure", icon="COLOR")
        if settings.legend:
            column = layout.column(align=True)
            for step in settings.legend:
                row = column.row(align=True)
                row.use_property_split = False
                row.prop(step, "color", text="")
                row.label(text=step.name)
            column.label(text="red: flipped or degenerate")


class PAPILLA_PT_material(_Section, bpy.types.Panel):
    bl_label = "Material and Grain"

    def draw(self, context):
        layout = self.layout
        layout.operator("papilla.assign_library", icon="MATERIAL")
        layout.operator("papilla.assign_grain", icon="IMAGE_DATA")
        material = _active_material(context)
        if material is None:
            return
        group = material.papilla_material
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.label(text=material.name, icon="MATERIAL")
        for name in ("library", "picture", "size_mm", "depth_mm", "unwrap"):
            layout.prop(group, name)
        if group.picture:
            layout.operator("papilla.show_grain")


class PAPILLA_PT_tag(_Section, bpy.types.Panel):
    bl_label = "Haptic Tag"

    def draw(self, context):
        layout = self.layout
        material = _active_material(context)
        if material is None:
            layout.label(text="the active object has no material")
            return
        try:
            tag = tag_store.read_short(material)
        except tags.TagError as error:
            layout.label(text=str(error), icon="ERROR")
            layout.operator("papilla.remove_tag")
            return
        layout.label(text=material.name, icon="MATERIAL")
        if tag is None:
            layout.operator("papilla.new_tag", icon="ADD")
            return
        layout.use_property_split = True
        layout.use_property_decorate = False
        group = material.papilla_material
        _draw_members(layout, group, "stiffness", "damping", "static_friction", "dynamic_friction", "stribeck_velocity")
        layout.prop(group, "has_backing")
        if "backing" in tag:
            _draw_members(layout.box(), group, "backing_stiffness", "backing_depth")
        if "height" in tag:
            _draw_height(layout.box(), group, tag)
        _draw_members(layout, group, "friction_model")
        if group.friction_model != "coulomb":
            _draw_members(layout, group, "bristle_stiffness")
        _draw_members(layout, group, "force_model")
        if group.force_model not in ("heightfield", "textured-normal"):
            _draw_members(layout, group, "force_amplitude")
        _draw_members(layout, group, "force_shading")
        for text in tags.problems(tag):
            layout.label(text=text, icon="ERROR")
        layout.label(text=f"version {tag['version']}")
        layout.operator("papilla.remove_tag", icon="REMOVE")


def _draw_members(layout, group, *names):
    column = layout.column(align=True)
    for name in names:
        column.prop(group, name)


def _draw_height(box, group, tag):
    height = tag["height"]
    size = height.get("size", ("?", "?"))
    box.label(text=f"Height map, {size[0]} x {size[1]}, {height.get('bits', 16)} bits", icon="TEXTURE")
    _draw_members(box, group, "height_scale", "height_offset", "height_outward", "height_width", "height_depth")


class PAPILLA_PT_files(_Section, bpy.types.Panel):
    bl_label = "Files"

    def draw(self, context):
        column = self.layout.column(align=True)
        column.operator("papilla.bake", icon="EXPORT")
        column.operator("import_scene.gltf", text="Import glTF", icon="IMPORT")
        column.operator("export_scene.gltf", text="Export glTF, Tags Kept", icon="EXPORT")


def _active_material(context):
    return context.active_object.active_material if context.active_object else None


CLASSES = (PAPILLA_PT_main, PAPILLA_PT_unwrap, PAPILLA_PT_distortion, PAPILLA_PT_material, PAPILLA_PT_tag, PAPILLA_PT_files)
