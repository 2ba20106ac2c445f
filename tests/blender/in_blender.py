# SPDX-License-Identifier: GPL-3.0-or-later
"""blender -b --factory-startup --python in_blender.py -- MODULE: installs the add-on as a user does and runs the tests of a
module in Blender's Python.

Environment: PAPILLA_ADDON the zip, PAPILLA_PROGRAM, PAPILLA_PLAYER, PAPILLA_MODULE the folder of the Python module (may be
empty), PAPILLA_COCKPIT a baked scene, PAPILLA_WORK a folder to write into.
"""
import os
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy

def install():
    bpy.ops.preferences.addon_install(filepath=os.environ["PAPILLA_ADDON"], overwrite=True)
    bpy.ops.preferences.addon_enable(module="papilla_blender")
    if "papilla_blender" not in bpy.context.preferences.addons:
        raise SystemExit("the add-on can't be enabled")


install()
names = sys.argv[sys.argv.index("--") + 1:]
outcome = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(unittest.defaultTestLoader.loadTestsFromNames(names))
sys.stdout.flush()
sys.exit(0 if outcome.wasSuccessful() and outcome.testsRun else 1)
