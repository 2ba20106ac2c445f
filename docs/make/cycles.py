# SPDX-License-Identifier: MIT
"""Compares photographs by `papilla synthesize photo` with those that Blender's Cycles renders of the same relief:
blender -b --factory-startup --python cycles.py -- RELIEF.exr PITCH_MM PHOTO.exr X,Y,Z
prints a row of a table: correlation and rms difference in % of the mean over the middle three quarters, of points in the
pixels' centres, of means over the pixels, and of those with light that is scattered from facet to facet."""
import math
import sys

import bpy
import numpy as np


def grey(path):
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    return np.array(image.pixels[:], dtype=np.float64).reshape(height, width, 4)[::-1, :, 0]


def add_relief(heights):
    rows, columns = heights.shape
    x, y = np.meshgrid(np.arange(columns) + 0.5, rows - 0.5 - np.arange(rows))
    index = np.arange(rows * columns).reshape(rows, columns)
    faces = np.stack([index[1:, :-1], index[1:, 1:], index[:-1, 1:], index[:-1, :-1]], -1).reshape(-1, 4)
    mesh = bpy.data.meshes.new("relief")
    mesh.from_pydata(np.stack([x, y, heights], -1).reshape(-1, 3).tolist(), [], faces.tolist())
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    material = bpy.data.materials.new("matt")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (0.8, 0.8, 0.8, 1)
    diffuse.inputs["Roughness"].default_value = 0
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    mesh.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("relief", mesh))


def add_light_and_camera(light, rows, columns, top):
    scene = bpy.context.scene
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle = math.pi, 0
    across = math.hypot(light[0], light[1])
    sun.rotation_euler = (math.atan2(across, light[2]), 0, math.atan2(-light[1], light[0]) + math.pi / 2)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", max(rows, columns)
    camera.data.clip_end = 1e5
    camera.location = (columns / 2, rows / 2, top + 100)
    for thing in (sun, camera):
        scene.collection.objects.link(thing)
    scene.camera = camera


def prepare(rows, columns):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", 32, 1
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.world = bpy.data.worlds.new("dark")
    scene.world.color = (0, 0, 0)
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = columns, rows, 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Raw"


def render(pixel_filter, bounces, path):
    scene = bpy.context.scene
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = bounces
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = pixel_filter, 0.01  # A box is always a pixel wide.
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return grey(path)


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:]
    relief, pitch, photograph, light = arguments[0], float(arguments[1]), arguments[2], arguments[3]
    light = [float(part) for part in light.split(",")]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    heights = grey(relief) / pitch
    rows, columns = heights.shape
    add_relief(heights)
    add_light_and_camera(light, rows, columns, heights.max())
    prepare(rows, columns)
    own = grey(photograph)
    middle = np.s_[rows // 8: -rows // 8, columns // 8: -columns // 8]
    cells = []
    for name, pixel_filter, bounces in ("centre", "BLACKMAN_HARRIS", 0), ("mean", "BOX", 0), ("scattered", "BOX", 4):
        a = render(pixel_filter, bounces, f"{photograph}.{name}.exr")[middle].ravel()
        b = own[middle].ravel()
        b = b * (a @ b) / (b @ b)
        rms = 100 * np.sqrt(np.mean((a - b) ** 2)) / a.mean()
        cells.append(f"{np.corrcoef(a, b)[0, 1]:.3f}, {rms:.1f} %")
    print("cycles: | " + " | ".join(cells) + " |")


main()
