# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests in Blender share: a clean scene, the engines, glTF files as JSON."""
import json
import os
import struct
import subprocess
import sys

import bpy

addon = sys.modules["papilla_blender"]
PROGRAM, PLAYER, MODULE = (os.environ[f"PAPILLA_{name}"] for name in ("PROGRAM", "PLAYER", "MODULE"))
WORK = os.environ["PAPILLA_WORK"]


def settings():
    return bpy.context.window_manager.papilla


def use_engine(choice):
    chosen = bpy.context.preferences.addons["papilla_blender"].preferences
    chosen.program, chosen.module_folder, chosen.engine = PROGRAM, MODULE, choice
    chosen.material_library = os.environ["PAPILLA_MATERIAL_LIBRARY"]


def engines():
    return ("PROGRAM", "MODULE") if MODULE else ("PROGRAM",)


def empty_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # Factory settings forget what was enabled.
    if "papilla_blender" not in bpy.context.preferences.addons:
        bpy.ops.preferences.addon_enable(module="papilla_blender")


def suzanne(size=0.2):
    bpy.ops.mesh.primitive_monkey_add(size=size)
    return bpy.context.object


def place(name):
    return os.path.join(WORK, name)


def document(path):
    """The JSON of a GLB."""
    with open(path, "rb") as file:
        data = file.read()
    return json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])


def with_document(path, change, target):
    """Writes the GLB with its JSON changed by hand."""
    with open(path, "rb") as file:
        data = file.read()
    length = struct.unpack("<I", data[12:16])[0]
    told = json.loads(data[20:20 + length])
    change(told)
    text = json.dumps(told).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length:]
    with open(target, "wb") as file:
        file.write(b"glTF" + struct.pack("<II", 2, 20 + len(text) + len(rest)) + struct.pack("<I", len(text)) + b"JSON" + text + rest)


def tags_of(path):
    return {m["name"]: m["extras"]["haptic"] for m in document(path)["materials"] if "haptic" in m.get("extras", {})}


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, encoding="utf-8")
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))}: {done.stderr}")
    return done.stdout
