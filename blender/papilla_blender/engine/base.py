# SPDX-License-Identifier: GPL-3.0-or-later
import abc
import dataclasses
import math

import numpy as np


class EngineError(Exception):
    """One line of the library: what is wrong, and where."""


class Cancelled(Exception):
    """The user did not want to wait."""


@dataclasses.dataclass
class Mesh:
    """A surface in millimetres, Z up."""

    name: str
    positions: np.ndarray  # (n, 3) float64
    triangles: np.ndarray  # (m, 3) int32, counter-clockwise seen from outside
    uv: np.ndarray = None  # (m, 3, 2) float64, a value per corner

    def __post_init__(self):
        if not len(self.triangles):
            raise EngineError(f"{self.name}: it has no face")
        if not np.isfinite(self.positions).all():
            raise EngineError(f"{self.name}: a position is not finite")
        if self.uv is not None and not np.isfinite(self.uv).all():
            raise EngineError(f"{self.name}: a texture coordinate is not finite")


@dataclasses.dataclass
class UnwrapSettings:
    method: str = "auto"
    options: dict = dataclasses.field(default_factory=dict)  # names and values of MATERIALS.json
    effort: str = "normal"
    gutter_mm: float = None  # least distance of charts; None: the program's own


@dataclasses.dataclass
class Unwrapped:
    uv: list  # by mesh: (m, 3, 2) in millimetres, or None where there is no map
    failures: list  # by mesh: why there is none, or ""
    charts: int
    methods: list  # by mesh: the method that was taken
    summary: dict  # numbers of `papilla measure` for all of it


@dataclasses.dataclass
class Distortion:
    """Per triangle, mesh after mesh; `measured`: degenerate neither in space nor in uv."""

    area_mm2: np.ndarray
    symmetric_dirichlet: np.ndarray
    stretch_l2: np.ndarray
    flipped: np.ndarray
    measured: np.ndarray
    summary: dict

    def values(self, measure):
        """NaN where a triangle is not measured."""
        return np.where(self.measured, getattr(self, measure), math.nan)


@dataclasses.dataclass
class Baked:
    surfaces: int  # with relief
    notes: list  # what was left behind, rules that took nothing, what looked wrong: a sentence each


# Of the numbers of `papilla measure`, those that are shown. Dots lead into objects.
SUMMARY = ("triangles", "charts", "flipped", "overlap_area_fraction", "stretch_l2", "stretch_linf",
           "symmetric_dirichlet.mean", "symmetric_dirichlet.max", "angle_error_deg.mean", "angle_error_deg.max",
           "area_ratio.min", "area_ratio.max", "seam_length_mm")


class Engine(abc.ABC):
    """`progress(stage, fraction)` is called while a call runs; when it returns False the call ends with Cancelled. All
    calls raise EngineError for input that can't be used.
    """

    label: str  # "module papilla 0.1.0"

    @abc.abstractmethod
    def methods(self):
        """Names of the methods of unwrapping."""

    @abc.abstractmethod
    def environment_maps(self):
        """Choices of the method environment."""

    @abc.abstractmethod
    def efforts(self):
        """Names of what may be spent on a map."""

    @abc.abstractmethod
    def normalizations(self):
        """Names of what shares the factor that makes areas in uv those in space."""

    @abc.abstractmethod
    def materials(self):
        """The library, a LibraryEntry for each material in the order of ids."""

    @abc.abstractmethod
    def unwrap(self, meshes, settings, progress=None):
        """Unwrapped, in one atlas for all meshes."""

    @abc.abstractmethod
    def measure(self, meshes, normalize, progress=None):
        """Distortion of the uv that meshes have."""

    @abc.abstractmethod
    def bake(self, scene, rules, output, progress=None):
        """Bakes the glTF file `scene` by the file `rules` into `output`. @return Baked."""


@dataclasses.dataclass(frozen=True)
class LibraryEntry:
    """A material of the library."""

    id: str  # "leather/nappa-fine"
    name: str
    uses: tuple
    stiffness: float
    damping: float
    static_friction: float
    dynamic_friction: float
    stribeck_velocity: float
    backing: tuple  # (stiffness, depth in mm), or None
    size_mm: tuple  # of one repeat of the relief, or None
    depth_mm: float  # of the relief, or None
    color: str  # "#rrggbb", sRGB
    roughness: float
    metallic: float


def summary_of(numbers):
    """The part of a dictionary with the keys of `papilla measure` that is shown, flat."""
    flat = {}
    for name in SUMMARY:
        value = numbers
        for key in name.split("."):
            value = value[key]
        flat[name] = value
    return flat


def clean_name(name):
    """One line, for files that hold a name a line."""
    return " ".join("".join(c if c.isprintable() else " " for c in name).split()) or "mesh"
