# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of the library and grain photographs as materials of Blender."""
import os

import bpy

from . import tag_store
from .distortion import linear
from .meshes import units_of
from .rules import MaterialRule, tag_of_library

_nodes = ("Papilla UV", "Papilla Scale", "Papilla Grain")


def material_of_library(entry):
    """The material of this entry: made where the file has none that is of it."""
    for material in bpy.data.materials:
        if material.papilla_material.library == entry.id:
            return material
    material = bpy.data.materials.new(entry.name)
    material.use_nodes = True
    group = material.papilla_material
    group.library = entry.id
    if entry.size_mm:
        group.size_mm, group.depth_mm = entry.size_mm, entry.depth_mm
    tag_store.write(material, tag_of_library(entry))
    colour = (*linear([int(entry.color[i:i + 2], 16) for i in (1, 3, 5)]), 1)
    shader = _shader(material)
    for socket, value in (("Base Color", colour), ("Roughness", entry.roughness), ("Metallic", entry.metallic)):
        shader.inputs[socket].default_value = value
    material.diffuse_color = colour
    return material


def show_picture(material, mesh, layer):
    """Lays the material's photograph on the uv of a layer at its scale: nodes of coordinates, scale and picture, which
    Blender's exporter writes as KHR_texture_transform.
    """
    group = material.papilla_material
    material.use_nodes = True
    tree = material.node_tree
    for name in _nodes:
        if name in tree.nodes:
            tree.nodes.remove(tree.nodes[name])
    coordinates, scale, picture = (tree.nodes.new(kind) for kind in
                                   ("ShaderNodeUVMap", "ShaderNodeMapping", "ShaderNodeTexImage"))
    for node, name, place in zip((coordinates, scale, picture), _nodes, (-900, -700, -450)):
        node.name = node.label = name
        node.location = (place, 300)
    coordinates.uv_map = layer
    unit = units_of(mesh).get(layer, 1.0)
    scale.inputs["Scale"].default_value = (unit / group.size_mm[0], unit / group.size_mm[1], 1)
    picture.image = bpy.data.images.load(bpy.path.abspath(group.picture), check_existing=True)
    tree.links.new(coordinates.outputs["UV"], scale.inputs["Vector"])
    tree.links.new(scale.outputs["Vector"], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], _shader(material).inputs["Base Color"])


def _shader(material):
    nodes = material.node_tree.nodes
    found = next((n for n in nodes if n.type == "BSDF_PRINCIPLED"), None)
    return found or nodes.new("ShaderNodeBsdfPrincipled")


def assign(objects, material):
    """Into the active slot of each mesh object, or its first one."""
    for obj in objects:
        if obj.material_slots:
            obj.material_slots[max(0, obj.active_material_index)].material = material
        else:
            obj.data.materials.append(material)


def rules_of(objects):
    """The rules of the materials that objects show, a rule a material. @throws TagError."""
    shown = {slot.material.name: slot.material for obj in objects for slot in obj.material_slots if slot.material}
    return [_rule_of(material) for material in shown.values()]


def _rule_of(material):
    group = material.papilla_material
    picture = os.path.realpath(bpy.path.abspath(group.picture)) if group.picture else ""
    unwrap = "" if group.unwrap == "auto" else group.unwrap
    return MaterialRule(material.name, group.library, picture, tuple(group.size_mm), group.depth_mm, unwrap,
                        tag_store.read_short(material))
