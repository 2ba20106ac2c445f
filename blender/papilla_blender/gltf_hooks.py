# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender's glTF add-on calls on import and export (classes of these names in every enabled add-on), 3.4 to 4.x.

Tags come and go with any import and export of glTF: nothing has to be ticked.
"""
import base64
import json
import pathlib
import urllib.parse

from . import tag_store
from .tag import HOLDERS_OF_PICTURES, TagError, check

OWN = ("haptic", "papilla")  # members of materials[].extras that are kept
STALE = "hapticMaterials"  # of nodes[].extras: copies of the tags, which editing would leave behind


def _report(text):
    print(f"papilla: {text}")


def restore_numpy_bool():
    """Blender 3.4's glTF importer asks numpy for `bool`, a name that numpy 1.24 does not have any more, as on Debian 12:
    every import ends there. Older numpy's is Python's; where there is one it stays.
    """
    import numpy

    if "bool" not in vars(numpy):
        numpy.bool = bool


def with_embedded_pictures(tag, gltf_file):
    """The tag with the pictures that lie beside the glTF file as data: URIs; the file that is exported lies elsewhere.
    @throws TagError for a picture outside of the folder or an image of the file that Blender does not import; OSError.
    """
    tag = check(tag)
    folder = pathlib.Path(gltf_file).resolve().parent
    for holder in HOLDERS_OF_PICTURES:
        told = tag.get(holder)
        if not isinstance(told, dict):
            continue
        uri = told.get("uri")
        if not uri and told.get("image"):
            _report(f"{holder} '{told['image']}' is an image of the file: it stays only where a texture shows it")
        if not uri or uri.startswith("data:"):
            continue
        path = (folder / urllib.parse.unquote(uri)).resolve()
        if folder not in path.parents:
            raise TagError(f"{holder}.uri {uri!r} leads out of the file's folder")
        tag = {**tag, holder: {**told, "uri": "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode()}}
    return tag


class glTF2ImportUserExtension:
    def __init__(self):
        self.extensions = []
        restore_numpy_bool()

    def gather_import_material_after_hook(self, gltf_material, vertex_color, blender_material, gltf):
        extras = gltf_material.extras
        if not isinstance(extras, dict):
            return
        if isinstance(extras.get("papilla"), dict):
            blender_material.papilla_material.origin = json.dumps(extras["papilla"])
        if "haptic" in extras:
            try:
                tag_store.write(blender_material, with_embedded_pictures(extras["haptic"], gltf.filename))
            except (TagError, OSError) as error:
                _report(f"material {blender_material.name}: its haptic tag is none: {error}")
        for key in OWN:
            if key in blender_material:
                del blender_material[key]

    def gather_import_node_after_hook(self, vnode, gltf_node, blender_object, gltf):
        if STALE in blender_object:
            del blender_object[STALE]


class glTF2ExportUserExtension:
    def __init__(self):
        self.is_critical = True  # newer versions than 4.2 end an export that would lose a tag

    def gather_material_hook(self, gltf2_material, blender_material, export_settings):
        group = getattr(blender_material, tag_store.GROUP, None)
        if group is None:
            return
        extras = {k: v for k, v in (gltf2_material.extras or {}).items() if k not in (*OWN, tag_store.GROUP)}
        if group.origin:
            extras["papilla"] = json.loads(group.origin)
        try:
            tag = tag_store.read(blender_material)
        except TagError as error:
            raise TagError(f"material {blender_material.name}: what it keeps as haptic tag is none: {error}") from error
        if tag is not None:
            extras["haptic"] = tag
        gltf2_material.extras = extras or None
