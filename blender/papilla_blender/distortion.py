# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures of distortion per triangle and face, and their colours: those of `papilla measure`."""
import dataclasses

import numpy as np

SYMMETRIC_DIRICHLET = "symmetric_dirichlet"
STRETCH = "stretch_l2"

# Named colours of the scale viridis, sRGB, as the program's pictures have them.
_viridis = np.array([[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129],
                     [92, 200, 99], [170, 220, 50], [253, 231, 37]])
WRONG = (220, 30, 30)  # flipped or degenerate


@dataclasses.dataclass(frozen=True)
class Measure:
    name: str
    label: str
    least: float  # of an isometry
    worst: float  # default end of the scale
    description: str


MEASURES = (
    Measure(SYMMETRIC_DIRICHLET, "Symmetric Dirichlet", 4.0, 5.0,
            "\u03c31\u00b2 + \u03c32\u00b2 + 1/\u03c31\u00b2 + 1/\u03c32\u00b2 of the singular values of the map from surface to uv: 4 for an isometry"),
    Measure(STRETCH, "Stretch", 1.0, 1.5,
            "Root of the mean square of the singular values of the map from uv to the surface: 1 for an isometry, more where a texture is pulled apart"),
)


def measure_named(name):
    return next(m for m in MEASURES if m.name == name)


def value_per_face(values, areas, faces, face_count):
    """Means over the triangles of each face, by area in space; NaN where no triangle of a face has a value."""
    known = np.isfinite(values) & (areas > 0)
    weight = np.bincount(faces[known], areas[known], face_count)
    total = np.bincount(faces[known], areas[known] * values[known], face_count)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(weight > 0, total / weight, np.nan)


def any_per_face(marked, faces, face_count):
    """Whether a triangle of each face is marked."""
    return np.bincount(faces[marked], minlength=face_count) > 0


def colour_bytes(values, measure, worst):
    """(n, 3) sRGB of 0 to 255 on the scale from the measure's least value to `worst`; NaN: flipped or degenerate."""
    place = np.clip((np.nan_to_num(values) - measure.least) / (worst - measure.least), 0, 1) * (len(_viridis) - 1)
    i = np.minimum(place.astype(int), len(_viridis) - 2)
    mixed = _viridis[i] + (place - i)[:, None] * (_viridis[i + 1] - _viridis[i])
    return np.where(np.isfinite(values)[:, None], np.floor(mixed + 0.5), WRONG).astype(np.uint8)


def linear(colours):
    """sRGB of 0 to 255 to linear light of 0 to 1."""
    c = np.asarray(colours, float) / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def legend(measure, worst, steps=5):
    """Value and sRGB colour of even steps of the scale."""
    values = np.linspace(measure.least, worst, steps)
    return list(zip(values.tolist(), colour_bytes(values, measure, worst).tolist()))
