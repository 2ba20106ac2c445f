# SPDX-License-Identifier: GPL-3.0-or-later
"""The JSON Schemas that the program installs, which the build lays beside the add-on: what options and tags may hold."""
import functools
import json
import pathlib

# Laid there by the build; in the sources the schemas are where the program has them.
_packed = pathlib.Path(__file__).parent / "schemas"
_sources = pathlib.Path(__file__).parents[2]
_places = {
    "haptic-material": (_packed, _sources / "haptic" / "schema"),
    "materials": (_packed, _sources / "apps" / "papilla" / "schema"),
}


@functools.lru_cache(maxsize=None)
def schema(name):
    """The schema "haptic-material" or "materials"."""
    for folder in _places[name]:
        path = folder / f"{name}.schema.json"
        if path.is_file():
            return json.loads(path.read_text(encoding="utf-8"))
    raise FileNotFoundError(f"{name}.schema.json is not with the add-on: install papilla_blender.zip anew")


def member(node, path):
    """The schema of a member by its path, such as ("backing", "depth")."""
    for key in path:
        node = node["items"] if isinstance(key, int) else node["properties"][key]
    return node
