# SPDX-License-Identifier: MIT
# blender -b --factory-startup --python blender.py -- IN.glb OUT.glb 0|1: imports and exports, with extras or without.
import sys

import numpy

numpy.bool = bool  # Debian 12's Blender 3.4 uses the old name, which its numpy 1.24 has not any more.

import bpy

source, target, extras = sys.argv[sys.argv.index('--') + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=source)
bpy.ops.export_scene.gltf(filepath=target, export_format='GLB', export_extras=extras == '1')
