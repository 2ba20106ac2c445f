# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a Blender material keeps its haptic tag: the property group `papilla_material`."""
from . import tag as tags

GROUP = "papilla_material"
CUSTOM_PROPERTY = "haptic"  # of materials that were imported without this add-on


def has_tag(material):
    return bool(getattr(material, GROUP).tag) or CUSTOM_PROPERTY in material


def read(material):
    """The whole tag, or None. @throws TagError when what the material keeps is none."""
    group = getattr(material, GROUP)
    if group.tag:
        return tags.unpack(group.tag, group.pictures)
    if CUSTOM_PROPERTY in material:
        return tags.from_custom_property(material[CUSTOM_PROPERTY])
    return None


def read_short(material):
    """The tag without the bytes of its pictures, or None: what panels look at."""
    group = getattr(material, GROUP)
    if group.tag:
        return tags.unpack(group.tag, "")
    tag = read(material)
    return tag and tags.unpack(tags.pack(tag)[0], "")


def write(material, tag):
    """Keeps a whole tag; None: takes it away. The custom property of an import without the add-on goes."""
    group = getattr(material, GROUP)
    group.tag, group.pictures = tags.pack(tags.check(tag)) if tag is not None else ("", "")
    if CUSTOM_PROPERTY in material:
        del material[CUSTOM_PROPERTY]


def write_short(material, tag):
    """Keeps a tag that read_short() gave, edited; the pictures stay."""
    group = getattr(material, GROUP)
    if not group.tag:
        write(material, read(material))
    group.tag = tags.pack(tags.check(tag))[0]
