# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

from . import operators, panel, preferences, properties

_classes = (preferences.PapillaPreferences, *properties.CLASSES, *operators.CLASSES, *panel.CLASSES)


def register():
    for cls in _classes:
        bpy.utils.register_class(cls)
    properties.register()


def unregister():
    properties.unregister()
    for cls in reversed(_classes):
        bpy.utils.unregister_class(cls)
