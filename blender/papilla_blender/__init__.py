# SPDX-License-Identifier: GPL-3.0-or-later
"""Papilla in Blender: unwrapping in millimetres, distortion, grain, and the haptic tag of glTF materials.

Nothing here needs bpy before register() is called, so that what computes can be used and tested by plain Python.
"""
from .gltf_hooks import glTF2ExportUserExtension, glTF2ImportUserExtension  # noqa: F401  (Blender's glTF add-on looks for them)

bl_info = {
    "name": "Papilla",
    "author": "Papilla maintainers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D Viewport > Sidebar > Papilla",
    "description": "Unwrap in millimetres, distortion, grain and haptic tags of glTF",
    "category": "UV",
}


def register():
    from . import registration

    registration.register()


def unregister():
    from . import registration

    registration.unregister()


def draw_import(context, layout):
    """Blender's glTF import dialog from 4.2 on asks every add-on with hooks for its options; there are none."""


def draw_export(context, layout):
    """The same of the export dialog."""
