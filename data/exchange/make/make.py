# SPDX-License-Identifier: MIT
# Blender's part of make.sh: an air vent of triangulated parts, with instances, materials and a texture, in every format
# that Blender writes. Prints the triangles of each file.
import os

import bpy

out, work = os.environ["OUT"], os.environ["WORK"]
bpy.ops.wm.read_factory_settings(use_empty=True)


def picture(name, size):
    """A checker with a ramp, as PNG beside the files."""
    image = bpy.data.images.new(name, size, size)
    image.pixels = [
        channel
        for y in range(size)
        for x in range(size)
        for channel in ((x // 4 + y // 4) % 2, x / size, y / size, 1.0)
    ]
    image.file_format = "PNG"
    image.filepath_raw = os.path.join(out, name + ".png")
    image.save()
    return image


def material(name, color, metallic, roughness, image=None):
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    nodes, links = result.node_tree.nodes, result.node_tree.links
    surface = nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = color
    surface.inputs["Metallic"].default_value = metallic
    surface.inputs["Roughness"].default_value = roughness
    if image:
        texture = nodes.new("ShaderNodeTexImage")
        texture.image = image
        links.new(texture.outputs["Color"], surface.inputs["Base Color"])
    return result


def part(name, stl, surface):
    """A mesh read from a file of DRAW, with uv and a material, in metres."""
    bpy.ops.import_mesh.stl(filepath=os.path.join(work, stl), global_scale=0.001)
    made = bpy.context.object
    made.name = made.data.name = name
    made.data.materials.append(surface)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cube_project(cube_size=0.05)
    bpy.ops.object.mode_set(mode="OBJECT")
    return made


def copy(original, name, parent, place):
    """Another object with the same mesh."""
    made = bpy.data.objects.new(name, original.data)
    bpy.context.collection.objects.link(made)
    made.parent, made.location = parent, place
    return made


frame = part("vent_frame", "vent_frame.stl", material("satin", (0.25, 0.27, 0.28, 1), 0.9, 0.4))
slat = part("vent_slat", "vent_slat.stl", material("grained", (1, 1, 1, 1), 0, 0.7, picture("checker", 16)))
slider = part("vent_slider", "vent_slider.stl", material("chrome", (0.7, 0.72, 0.75, 1), 1, 0.1))
vent = bpy.data.objects.new("air_vent", None)
bpy.context.collection.objects.link(vent)
vent.location, vent.rotation_euler = (0.1, -0.6, 0.9), (0.2, 0, 0.4)
for piece in (frame, slat, slider):
    piece.parent = vent
slat.location = (0, 0.012, -0.01925)
for number in range(1, 8):
    copy(slat, f"vent_slat.{number:03}", vent, (0, 0.012, -0.01925 + 0.0055 * number))
slider.location, slider.scale = (0, 0.003, 0.00275), (1.5, 1, -1)
bpy.ops.mesh.primitive_grid_add(x_subdivisions=5, y_subdivisions=4, size=0.2)  # quads
bpy.context.object.name = bpy.context.object.data.name = "wall"

bpy.ops.export_scene.gltf(filepath=os.path.join(out, "vent.glb"), export_format="GLB")
bpy.ops.export_scene.gltf(filepath=os.path.join(out, "vent.gltf"), export_format="GLTF_SEPARATE", export_normals=False)
bpy.ops.object.select_all(action="DESELECT")
for made in (frame, slat, bpy.data.objects["wall"]):
    made.select_set(True)
bpy.ops.wm.obj_export(filepath=os.path.join(out, "vent.obj"), export_selected_objects=True, path_mode="STRIP")
bpy.ops.object.select_all(action="DESELECT")
slider.select_set(True)
bpy.context.view_layer.objects.active = slider
bpy.ops.export_mesh.stl(filepath=os.path.join(out, "slider.stl"), use_selection=True, global_scale=1000)
bpy.ops.export_mesh.stl(filepath=os.path.join(out, "slider_ascii.stl"), use_selection=True, global_scale=1000, ascii=True)
bpy.ops.export_mesh.ply(filepath=os.path.join(out, "slider.ply"), use_selection=True, global_scale=1000)
bpy.ops.export_mesh.ply(filepath=os.path.join(out, "slider_ascii.ply"), use_selection=True, global_scale=1000, use_ascii=True)

triangles = {}
for made in bpy.data.objects:
    if made.type == "MESH":
        made.data.calc_loop_triangles()
        triangles[made.name] = len(made.data.loop_triangles)
print("triangles:", triangles, "all:", sum(triangles.values()))
