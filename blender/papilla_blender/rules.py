# SPDX-License-Identifier: GPL-3.0-or-later
"""MATERIALS.json of what Blender's materials say: library, grain photographs with their scale, and tags."""
import dataclasses
import re

from . import tag as tags


@dataclasses.dataclass
class MaterialRule:
    name: str
    library: str = ""  # id
    picture: str = ""  # absolute path
    size_mm: tuple = (0.0, 0.0)  # that the picture shows; 0: as the library says
    depth_mm: float = 0.0  # of the relief; 0: the program's own
    unwrap: str = ""  # empty: auto
    tag: dict = None

    def is_baked(self):
        return bool(self.library or self.picture)


def materials_json(rules):
    """What `papilla bake -m` reads."""
    baked = [rule for rule in rules if rule.is_baked()]
    return {"materials": {rule.name: _material(rule) for rule in baked},
            "assign": [{"gltf_material": literal(rule.name), "material": rule.name} for rule in baked]}


def literal(name):
    """A pattern that fits this name only: * ? and [ are letters there."""
    return re.sub(r"([*?\[])", r"[\1]", name)


def _material(rule):
    material = {}
    if rule.library:
        material["material"] = f"library:{rule.library}"
    if rule.picture:
        material["texture"] = rule.picture
    if all(side > 0 for side in rule.size_mm):
        material["size_mm"] = list(rule.size_mm)
    if rule.depth_mm > 0:
        material["height"] = {"depth_mm": rule.depth_mm}
    if rule.unwrap:
        material["unwrap"] = rule.unwrap
    if rule.tag:
        material.update(_constants(rule.tag))
    return material


def _constants(tag):
    found = {key: tag[key] for key in ("stiffness", "damping", "staticFriction", "dynamicFriction", "stribeckVelocity",
                                       "forceModel", "frictionModel", "forceShading") if key in tag}
    backing = tag.get("backing")
    found["backing"] = backing and {"stiffness": backing["stiffness"], "depth_mm": 1000 * backing["depth"]}
    return found


def tag_of_library(entry):
    """The tag that a material of the library begins with."""
    tag = {"version": 1, "stiffness": entry.stiffness, "damping": entry.damping, "staticFriction": entry.static_friction,
           "dynamicFriction": entry.dynamic_friction, "stribeckVelocity": entry.stribeck_velocity}
    if entry.backing:
        tag["backing"] = {"stiffness": entry.backing[0], "depth": entry.backing[1] / 1000}
    return tags.with_version(tag)
