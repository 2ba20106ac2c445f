# SPDX-License-Identifier: GPL-3.0-or-later
"""The haptic tag of a material (docs/haptic-material.md) as Blender keeps it, and its members as a panel shows them.

A tag is a dictionary of JSON. Blender keeps two texts of it: the tag without the bytes of its pictures, which is short
and parsed whenever a panel is drawn, and the pictures. Numbers go through Python's shortest decimal form, so that what
nobody edits comes out bit by bit.
"""
import ast
import copy
import dataclasses
import functools
import json
import math

from .schemas import member, schema

HOLDERS_OF_PICTURES = ("height", "maps")


class TagError(ValueError):
    """What is no haptic tag."""


@dataclasses.dataclass(frozen=True)
class Member:
    """A member of the tag that a panel edits. The value shown is `factor` times that of the tag."""

    name: str  # of the property
    path: tuple
    label: str
    factor: float = 1.0
    soft_max: float = None  # of sliders, in the unit shown
    precision: int = 3

    @property
    def schema(self):
        return member(schema("haptic-material"), self.path)

    @property
    def kind(self):
        """"choice", "flag", "whole" or "number"."""
        if "enum" in self.schema:
            return "choice"
        return {"boolean": "flag", "integer": "whole"}.get(self.schema["type"], "number")

    @property
    def limits(self):
        """Least and largest value, in the unit shown; where the schema has no largest one, what Blender can show."""
        return self.schema["minimum"] * self.factor, min(self.schema.get("maximum", math.inf) * self.factor, 1e9)

    @property
    def description(self):
        text = self.schema.get("description", self.label)
        return f"{text}. {'.'.join(map(str, self.path))} of the tag"


MEMBERS = (
    Member("stiffness", ("stiffness",), "Stiffness [N/m]", soft_max=3000, precision=1),
    Member("damping", ("damping",), "Damping [N\u00b7s/m]", soft_max=5),
    Member("static_friction", ("staticFriction",), "Static friction", soft_max=1.5),
    Member("dynamic_friction", ("dynamicFriction",), "Dynamic friction", soft_max=1.5),
    Member("stribeck_velocity", ("stribeckVelocity",), "Stribeck velocity [mm/s]", factor=1e3, soft_max=100),
    Member("force_shading", ("forceShading",), "Shade forces over facets"),
    Member("backing_stiffness", ("backing", "stiffness"), "Stiffness [N/m]", soft_max=10000, precision=1),
    Member("backing_depth", ("backing", "depth"), "Begins at a depth of [mm]", factor=1e3, soft_max=20),
    Member("height_scale", ("height", "scale"), "Black to white [mm]", factor=1e3, soft_max=2, precision=4),
    Member("height_offset", ("height", "offset"), "Height of black [mm]", factor=1e3, soft_max=2, precision=4),
    Member("height_outward", ("height", "outward"), "Outward is"),
    Member("height_width", ("height", "metresPerUV", 0), "Repeat in u [mm]", factor=1e3, soft_max=200),
    Member("height_depth", ("height", "metresPerUV", 1), "Repeat in v [mm]", factor=1e3, soft_max=200),
    Member("force_model", ("forceModel", "name"), "Force model"),
    Member("force_amplitude", ("forceModel", "amplitude"), "Amplitude [N per level]", soft_max=1, precision=4),
    Member("friction_model", ("frictionModel", "name"), "Friction model"),
    Member("bristle_stiffness", ("frictionModel", "stiffness"), "Bristles [N/m]", soft_max=3000, precision=1),
)


@functools.lru_cache(maxsize=None)
def member_named(name):
    return next(m for m in MEMBERS if m.name == name)


def new_tag():
    """A tag of the least that one must have."""
    return {"version": 1, "stiffness": float(member(schema("haptic-material"), ("stiffness",))["default"])}


def check(tag):
    """@throws TagError for what no reader takes as a tag."""
    if not isinstance(tag, dict):
        raise TagError("a haptic tag is a JSON object")
    known = schema("haptic-material")["properties"]["version"]["enum"]
    if isinstance(tag.get("version"), bool) or tag.get("version") not in known:
        raise TagError(f"version {tag.get('version')!r}: known are {', '.join(map(str, known))}")
    if "stiffness" not in tag and "height" not in tag:
        raise TagError("it has neither stiffness nor height")
    return tag


def _number(value):
    return value if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def value_of(tag, which):
    """The value of a member in the unit shown; what readers take where the tag has none."""
    node = tag
    for key in which.path:
        if isinstance(key, int):
            node = node[key] if isinstance(node, list) and key < len(node) else None
        else:
            node = node.get(key) if isinstance(node, dict) else None
    if which.kind == "flag":
        return node is True
    if which.kind == "choice":
        choices = which.schema["enum"]
        return node if node in choices else which.schema.get("default", choices[0])
    if _number(node) is None:
        node = _default(tag, which)
    return round(node) if which.kind == "whole" else node * which.factor


def _default(tag, which):
    """Frictions stand for each other, as haptic-material.md says; the rest has defaults in the schema."""
    other = {"staticFriction": "dynamicFriction", "dynamicFriction": "staticFriction"}.get(which.path[-1])
    if other:
        return _number(tag.get(other)) or 0
    if isinstance(which.path[-1], int):
        return member(schema("haptic-material"), which.path[:-1])["default"][which.path[-1]]
    return which.schema.get("default", 0)


def with_value(tag, which, value):
    """A copy of the tag with one member set, in the unit shown, within its limits. Objects on the way are made."""
    if which.kind == "number":
        low, high = which.limits
        # Seven digits: what Blender's single precision holds, without the digits that it makes up.
        value = float(f"{min(max(value, low), high) / which.factor:.7g}")
    elif which.kind == "flag":
        value = bool(value)
    tag = copy.deepcopy(tag)
    node = tag
    for key, following in zip(which.path, which.path[1:]):
        if isinstance(following, int) and not isinstance(node.get(key), list):
            node[key] = list(member(schema("haptic-material"), which.path[:-1])["default"])
        node = node.setdefault(key, {}) if isinstance(node, dict) else node[key]
    node[which.path[-1]] = value
    return with_version(tag)


def with_backing(tag, wanted):
    """With a layer below the skin, twice as stiff from 2 mm on, or without."""
    tag = copy.deepcopy(tag)
    if wanted:
        tag.setdefault("backing", {"stiffness": 2 * value_of(tag, member_named("stiffness")), "depth": 0.002})
    else:
        tag.pop("backing", None)
    return with_version(tag)


def with_version(tag):
    """The version that what the tag has needs; never lowered."""
    rough = tag.get("roughness")
    newer = isinstance(rough, dict) and any(k in rough for k in ("hurst", "rms", "wavelength_range", "anisotropy", "overlay"))
    if newer or "backing" in tag or "maps" in tag:
        tag["version"] = max(2, tag["version"])
    return tag


def problems(tag):
    """What a player would warn of, one sentence each."""
    found = []
    fixed = value_of(tag, member_named("static_friction"))
    moving = value_of(tag, member_named("dynamic_friction"))
    if moving > fixed:
        found.append("Dynamic friction is above static friction")
    height = tag.get("height")
    if isinstance(height, dict) and not height.get("uri") and not height.get("image") and not height.get("sha256"):
        found.append("The height map is named nowhere")
    bristles = value_of(tag, member_named("bristle_stiffness"))
    if bristles > value_of(tag, member_named("stiffness")):
        found.append("Bristles are stiffer than the material")
    return found


def pack(tag):
    """The two texts that Blender keeps: the tag without its pictures, and the pictures by the member that has them."""
    short = dict(tag)
    pictures = {}
    for holder in HOLDERS_OF_PICTURES:
        uri = tag.get(holder, {}).get("uri") if isinstance(tag.get(holder), dict) else None
        if isinstance(uri, str) and uri.startswith("data:"):
            pictures[holder] = uri
            short[holder] = {**tag[holder], "uri": ""}  # keeps its place
    return json.dumps(short), json.dumps(pictures) if pictures else ""


def unpack(short, pictures):
    """@throws TagError when the texts are none of pack()."""
    try:
        tag = check(json.loads(short))
        for holder, uri in (json.loads(pictures) if pictures else {}).items():
            tag[holder]["uri"] = uri
    except (ValueError, KeyError, TypeError) as error:
        raise TagError(str(error)) from error
    return tag


def from_custom_property(value):
    """A tag out of a custom property "haptic", as Blender keeps what it imported while this add-on was off: a group or
    text in the notation of Python. True and false are 1 and 0 there.
    """
    if hasattr(value, "to_dict"):
        value = value.to_dict()
    elif isinstance(value, str):
        try:
            value = ast.literal_eval(value)
        except (ValueError, SyntaxError) as error:
            raise TagError("the custom property 'haptic' is no tag") from error
    tag = copy.deepcopy(check(value))
    for path in (("forceShading",), ("roughness", "overlay")):
        node = tag
        for key in path[:-1]:
            node = node.get(key, {})
        if isinstance(node, dict) and node.get(path[-1]) in (0, 1):
            node[path[-1]] = bool(node[path[-1]])
    return tag
