# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the engine is, and the engine."""
import bpy

from . import engine

PACKAGE = __package__  # "papilla_blender", or "bl_ext.….papilla_blender" as an extension of 4.2 and newer

_found = {}


def _forget(self, context):
    _found.clear()


class PapillaPreferences(bpy.types.AddonPreferences):
    bl_idname = PACKAGE

    engine: bpy.props.EnumProperty(
        name="Computed by",
        items=((engine.AUTOMATIC, "Module, else Program", "The Python module papilla where Blender's Python has it, else the program"),
               (engine.MODULE, "Python Module", "The module papilla, in Blender's own process"),
               (engine.PROGRAM, "Program", "The program papilla, by files in a temporary folder")),
        update=_forget)
    program: bpy.props.StringProperty(
        name="Program", subtype="FILE_PATH", update=_forget, description="The program papilla; empty: the one on PATH")
    module_folder: bpy.props.StringProperty(
        name="Folder of the Module", subtype="DIR_PATH", update=_forget,
        description="The folder that the Python module papilla lies in; empty: where Blender's Python looks")
    material_library: bpy.props.StringProperty(
        name="Material Library", subtype="DIR_PATH", update=_forget,
        description="Folder of the materials; empty: the one that is installed with papilla")

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        for name in ("engine", "program", "module_folder", "material_library"):
            layout.prop(self, name)
        try:
            layout.label(text=current_engine(context).label, icon="CHECKMARK")
        except engine.EngineError as error:
            layout.label(text=str(error), icon="ERROR")


def current_engine(context):
    """The engine of the preferences, found once. @throws EngineError."""
    chosen = context.preferences.addons[PACKAGE].preferences
    key = (chosen.engine, *(bpy.path.abspath(p) for p in (chosen.program, chosen.module_folder, chosen.material_library)))
    if key not in _found:
        try:
            _found[key] = engine.find_engine(*key)
        except engine.EngineError as error:
            _found[key] = error
    if isinstance(_found[key], Exception):
        raise _found[key]
    return _found[key]
