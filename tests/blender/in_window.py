# SPDX-License-Identifier: GPL-3.0-or-later
"""blender --enable-event-simulate --python in_window.py: the panel is drawn and long calls go on beside the window, with
progress and Esc. Ends Blender; the exit code is 1 when a step failed. PAPILLA_PICTURE: also writes the screen there.
"""
import os
import sys
import threading
import time
import traceback

sys.dont_write_bytecode = True

import bpy

ADDON, WORK = os.environ["PAPILLA_ADDON"], os.environ["PAPILLA_WORK"]
bpy.ops.preferences.addon_install(filepath=ADDON, overwrite=True)
bpy.ops.preferences.addon_enable(module="papilla_blender")
addon = sys.modules["papilla_blender"]
chosen = bpy.context.preferences.addons["papilla_blender"].preferences
chosen.program, chosen.engine, chosen.material_library = os.environ["PAPILLA_PROGRAM"], "PROGRAM", os.environ["PAPILLA_MATERIAL_LIBRARY"]
bpy.context.preferences.view.show_splash = False


# Every section is open, so that every one is drawn.
for section in addon.panel.CLASSES[1:]:
    bpy.utils.unregister_class(section)
    section.bl_options = set()
    bpy.utils.register_class(section)
drawn = []
addon.panel.PAPILLA_PT_files.append(lambda self, context: drawn.append(self.bl_label))


patience = 300  # seconds, of a busy machine


def window():
    return bpy.context.window_manager.windows[0]


def view():
    return next(area for area in window().screen.areas if area.type == "VIEW_3D")


def in_view(call, *arguments, **options):
    area = view()
    region = next(r for r in area.regions if r.type == "WINDOW")
    with bpy.context.temp_override(window=window(), area=area, region=region):
        return call(*arguments, **options)


def expect(truth, what):
    if not truth:
        raise AssertionError(what)


def settings():
    return bpy.context.window_manager.papilla


def click(x, y):
    for kind, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE")):
        window().event_simulate(type=kind, value=value, x=x, y=y)


def is_working():
    return any(thread.name == "papilla job" for thread in threading.enumerate())


def steps():
    """Yields to the window's loop."""
    in_view(bpy.ops.object.delete, use_global=False)  # the cube
    in_view(bpy.ops.mesh.primitive_monkey_add, size=0.2)
    suzanne = in_view(lambda: bpy.context.view_layer.objects.active)
    area = view()
    area.spaces[0].show_region_ui = True
    area.spaces[0].shading.color_type = "VERTEX"
    area.spaces[0].shading.light = "FLAT"
    area.spaces[0].overlay.show_overlays = False
    in_view(bpy.ops.view3d.view_selected)
    settings().method, settings().layer = "lscm", "papilla"
    yield
    expect(in_view(bpy.ops.papilla.unwrap, "INVOKE_DEFAULT") == {"RUNNING_MODAL"}, "unwrap goes on beside the window")
    expect("papilla" not in suzanne.data.uv_layers, "nothing is written yet")
    begun = time.time()
    while "papilla" not in suzanne.data.uv_layers:
        expect(time.time() - begun < patience, "the map comes")
        yield
    expect(settings().report[0].name.startswith("lscm: "), "the panel has the report")
    settings().worst = 4.2
    expect(in_view(bpy.ops.papilla.measure, "INVOKE_DEFAULT") == {"RUNNING_MODAL"}, "measure goes on beside the window")
    while "papilla distortion" not in suzanne.data.color_attributes:
        expect(time.time() - begun < patience, "the colours come")
        yield
    in_view(bpy.ops.papilla.assign_library, material="leather/nappa-fine")
    yield
    sidebar = next(r for r in view().regions if r.type == "UI")
    for _ in range(3):
        yield
    click(sidebar.x + sidebar.width - 12, sidebar.y + sidebar.height - 165)  # the tab Papilla
    for _ in range(20):
        yield
    expect(drawn, "the panel of the tab is drawn")
    if "PAPILLA_PICTURE" in os.environ:
        bpy.ops.screen.screenshot(filepath=os.environ["PAPILLA_PICTURE"])
    # Esc: a mesh that takes a while.
    in_view(bpy.ops.mesh.primitive_monkey_add, size=0.2)
    large = in_view(lambda: bpy.context.view_layer.objects.active)
    modifier = large.modifiers.new("fine", "SUBSURF")
    modifier.levels = 4
    in_view(bpy.ops.object.modifier_apply, modifier="fine")
    settings().method, settings().effort = "best", "best"
    expect(in_view(bpy.ops.papilla.unwrap, "INVOKE_DEFAULT") == {"RUNNING_MODAL"}, "a long call")
    for _ in range(5):
        yield
    expect(is_working(), "it still works")
    x, y = window().width // 2, window().height // 2
    window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    window().event_simulate(type="ESC", value="PRESS", x=x, y=y)
    window().event_simulate(type="ESC", value="RELEASE", x=x, y=y)
    begun = time.time()
    while is_working():
        expect(time.time() - begun < patience, "Esc ends the call")
        yield
    for _ in range(5):
        yield
    expect("papilla" not in large.data.uv_layers, "what is cancelled writes nothing")


progress = steps()


def turn():
    try:
        next(progress)
        return 0.1
    except StopIteration:
        print("the window's tests passed")
        sys.stdout.flush()
        os._exit(0)
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)


bpy.app.timers.register(turn, first_interval=1)
