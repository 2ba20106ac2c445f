# SPDX-License-Identifier: MIT
"""CAD interiors that can be seen and felt: scenes, charts, distortion, reliefs, recipes, bakes, contact.

Names, options and defaults are those of the C++ headers; docs/python.md tells how they come to Python. Structs are
classes whose fields are attributes and keywords; arrays within are numpy's, looked at in place. Enumerations are
strings, listed in `choices`. Lengths are millimetres in meshes and pictures, metres in contact.
"""
from ._papilla import *  # noqa: F401, F403
from ._papilla import __version__, choices  # noqa: F401


def _find_packed_materials():
    """A wheel brings the material library along; where there is none, the installed one is found as ever."""
    import os

    packed = os.path.join(os.path.dirname(__file__), "materials")
    if os.path.isdir(packed):
        os.environ.setdefault("PAPILLA_MATERIAL_LIBRARY", packed)


_find_packed_materials()
