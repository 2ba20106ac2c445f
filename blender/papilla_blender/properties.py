# SPDX-License-Identifier: GPL-3.0-or-later
"""What panels show: settings of the window manager, and what a material keeps."""
import functools
import json

import bpy
import numpy as np

from . import tag_store
from . import tag as tags
from .distortion import MEASURES, measure_named
from .engine import EngineError
from .preferences import current_engine
from .unwrap_options import from_text, options_of

GUTTER_IS_AUTOMATIC = 0.0


@functools.lru_cache(maxsize=256)
def enum_items(names):
    """Items of an enumeration of words. Blender needs them to stay alive."""
    return [(name, name, "", i) for i, name in enumerate(names)]


def _from_engine(ask, first):
    """Items that the engine names, `first` at the front, which is the default."""

    def items(self, context):
        try:
            names = ask(current_engine(context))
        except EngineError:
            names = [first]
        return enum_items((first, *(n for n in names if n != first)))

    return items


class PapillaOption(bpy.types.PropertyGroup):
    """An option of a method: one of the values counts, by its kind."""

    kind: bpy.props.StringProperty()
    description: bpy.props.StringProperty()
    choices: bpy.props.StringProperty()
    use: bpy.props.BoolProperty(name="Set", description="Give this option instead of leaving it to the program")
    number: bpy.props.FloatProperty(name="Value", precision=4)
    whole: bpy.props.IntProperty(name="Value", min=0)
    flag: bpy.props.BoolProperty(name="On", default=True)
    text: bpy.props.StringProperty(name="Value")
    choice: bpy.props.EnumProperty(name="Value", items=lambda self, context: enum_items(tuple(json.loads(self.choices or "[]"))))

    def value(self):
        """@throws EngineError for text that can't be read."""
        if self.kind == "number":
            return float(f"{self.number:.7g}")
        if self.kind == "text":
            try:
                return from_text(self.text)
            except ValueError as error:
                raise EngineError(f"{self.name}: {self.text!r} is no JSON: {error}") from error
        return getattr(self, self.kind)


def fill_options(settings, context):
    """Lists what the method can be told; what was set and is still there stays."""
    try:
        engine = current_engine(context)
        options = options_of(settings.method, engine.methods(), engine.environment_maps())
    except (EngineError, OSError):
        options = []
    kept = {item.name: (item.kind, item.use, getattr(item, item.kind)) for item in settings.options if item.use}
    settings.options.clear()
    for option in options:
        item = settings.options.add()
        item.name, item.kind, item.description = option.name, option.kind, option.description
        item.choices = json.dumps(option.choices)
        value = option.default
        kind, item.use, before = kept.get(option.name, (option.kind, False, value))
        if item.use and kind == option.kind and (kind != "choice" or before in option.choices):
            value = before
        if value is not None:
            setattr(item, item.kind, True if item.kind == "flag" and not item.use else value)


class PapillaLegend(bpy.types.PropertyGroup):
    """A step of the scale of colours. `name` is the number."""

    color: bpy.props.FloatVectorProperty(name="Colour of the Value", subtype="COLOR_GAMMA", size=3, min=0, max=1)


class PapillaLine(bpy.types.PropertyGroup):
    """A line of the last report."""


def _worst_of_measure(settings, context):
    settings.worst = settings.chosen_measure().worst


class PapillaSettings(bpy.types.PropertyGroup):
    method: bpy.props.EnumProperty(name="Method", description="How the surface is unwrapped", update=fill_options,
                                   items=_from_engine(lambda e: e.methods(), "auto"))
    effort: bpy.props.EnumProperty(name="Effort", description="What may be spent on charts, and on the maps of auto and best",
                                   items=_from_engine(lambda e: e.efforts(), "normal"))
    options: bpy.props.CollectionProperty(type=PapillaOption)
    gutter_mm: bpy.props.FloatProperty(name="Gutter [mm]", min=0, soft_max=50, precision=2, default=GUTTER_IS_AUTOMATIC,
                                       description="Least distance of charts; 0: the program's own, 0.5 % of the atlas")
    uv_space: bpy.props.EnumProperty(
        name="UV in",
        items=(("MM", "Millimetres", "A unit of uv is a millimetre on the surface: grain has its true scale"),
               ("ATLAS", "Atlas", "All charts of all objects within 0 and 1, at one scale, which the mesh keeps")))
    layer: bpy.props.StringProperty(name="UV Layer", default="papilla", description="Layer that is written and measured; it is made where there is none")
    measure: bpy.props.EnumProperty(name="Measure", items=[(m.name.upper(), m.label, m.description) for m in MEASURES],
                                    update=_worst_of_measure)
    normalize: bpy.props.EnumProperty(
        name="Scale of UV", items=_from_engine(lambda e: e.normalizations(), "scene"),
        description="What shares the factor that makes areas in uv those in space; none: uv count as millimetres")
    worst: bpy.props.FloatProperty(name="Yellow from", default=MEASURES[0].worst, min=1.0001, max=1e6, precision=3,
                                   description="Value at the end of the scale of colours")
    legend: bpy.props.CollectionProperty(type=PapillaLegend)
    report: bpy.props.CollectionProperty(type=PapillaLine)

    def chosen_measure(self):
        return measure_named(self.measure.lower())

    def given_options(self):
        return {item.name: item.value() for item in self.options if item.use}


def say(settings, lines):
    """Replaces the report that the panel shows."""
    settings.report.clear()
    for line in lines:
        settings.report.add().name = line


def _tag_or_new(material):
    try:
        return tag_store.read_short(material) or tags.new_tag()
    except tags.TagError:
        return tags.new_tag()


def _annotation(which):
    """The property that shows and edits a member of the tag of the material that it belongs to."""

    def read(self):
        return tags.value_of(_tag_or_new(self.id_data), which)

    def write(self, value):
        # Blender has single precision: a number that looks the same keeps the digits that it has in the tag.
        if np.float32(value) != np.float32(read(self)):
            tag_store.write_short(self.id_data, tags.with_value(_tag_or_new(self.id_data), which, value))

    shown = {"name": which.label, "description": which.description}
    if which.kind == "flag":
        return bpy.props.BoolProperty(get=read, set=write, **shown)
    if which.kind == "choice":
        words = which.schema["enum"]
        return bpy.props.EnumProperty(
            items=enum_items(tuple(words)), get=lambda self: words.index(read(self)),
            set=lambda self, i: tag_store.write_short(self.id_data, tags.with_value(_tag_or_new(self.id_data), which, words[i])),
            **shown)
    low, high = which.limits
    return bpy.props.FloatProperty(get=read, set=write, min=low, max=high, soft_min=max(low, -which.soft_max),
                                   soft_max=which.soft_max, precision=which.precision, **shown)


def _has_backing(self):
    return "backing" in _tag_or_new(self.id_data)


def _set_backing(self, wanted):
    tag_store.write_short(self.id_data, tags.with_backing(_tag_or_new(self.id_data), wanted))


class PapillaMaterial(bpy.types.PropertyGroup):
    """What a material keeps. Its tag is text (tag.py); the properties of its members look into it."""

    tag: bpy.props.StringProperty(name="Haptic Tag", description="JSON, without its pictures")
    pictures: bpy.props.StringProperty(name="Pictures of the Tag")
    origin: bpy.props.StringProperty(name="Material of Papilla", description="extras.papilla of the glTF file that it came from")
    library: bpy.props.StringProperty(name="Library", description="Material of the library whose look and relief bake gives it")
    picture: bpy.props.StringProperty(name="Grain", subtype="FILE_PATH", description="Photograph of the grain, which bake reads as relief")
    size_mm: bpy.props.FloatVectorProperty(name="Shows [mm]", size=2, min=0, soft_max=500, precision=2,
                                           description="Width and height in millimetres that the photograph shows; 0: as the library says")
    depth_mm: bpy.props.FloatProperty(name="Depth [mm]", min=0, max=100, soft_max=2, precision=3,
                                      description="Of the relief, peak to valley; 0: the program's own")
    unwrap: bpy.props.EnumProperty(
        name="UV", description="The texture coordinates that bake lays the grain on",
        items=lambda self, context: enum_items(("auto", "keep", "new", *(m for m in _methods(context) if m not in ("auto", "environment")))))
    has_backing: bpy.props.BoolProperty(
        name="Backing", get=_has_backing, set=_set_backing,
        description="Something stiffer below the skin, felt from a depth on")


def _methods(context):
    try:
        return current_engine(context).methods()
    except EngineError:
        return []


for _member in tags.MEMBERS:
    PapillaMaterial.__annotations__[_member.name] = _annotation(_member)

CLASSES = (PapillaOption, PapillaLegend, PapillaLine, PapillaSettings, PapillaMaterial)


def register():
    bpy.types.Material.papilla_material = bpy.props.PointerProperty(type=PapillaMaterial)
    bpy.types.WindowManager.papilla = bpy.props.PointerProperty(type=PapillaSettings)


def unregister():
    del bpy.types.Material.papilla_material
    del bpy.types.WindowManager.papilla
