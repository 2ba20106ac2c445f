# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module papilla, in this process."""
import importlib
import json
import pathlib
import re
import sys
import tempfile

import numpy as np

from .. import unwrap_options
from .base import Baked, Cancelled, Distortion, Engine, EngineError, LibraryEntry, Unwrapped, clean_name, summary_of


def find_module(folder):
    """@return (module, reason): None, or why there is none."""
    if folder and folder not in sys.path:
        sys.path.append(folder)
        importlib.invalidate_caches()
    try:
        return importlib.import_module("papilla"), ""
    except ImportError as error:
        return None, f"the Python module papilla can't be imported: {error}"


class ModuleEngine(Engine):
    def __init__(self, module, material_library=""):
        self._papilla = module
        self._library = material_library
        self.label = f"module papilla {module.__version__}"

    def methods(self):
        return sorted("auto" if name == "automatic" else name for name in self._papilla.choices["UnwrapMethod"])

    def environment_maps(self):
        return sorted(name.replace("_", "-") for name in self._papilla.choices["EnvironmentMap"])

    def efforts(self):
        return sorted(self._papilla.choices["UnwrapEffort"])

    def normalizations(self):
        return sorted(self._papilla.choices["UvNormalization"])

    def materials(self):
        library = self._call(self._papilla.MaterialLibrary, *([self._library] if self._library else []))
        return [_library_entry(material) for material in self._call(library.materials)]

    def unwrap(self, meshes, settings, progress=None):
        result = self._call(
            self._papilla.unwrap_scene, self._scene(meshes), method=self._method(settings), sides={"keep": True},
            gutter_mm=settings.gutter_mm, progress=progress)
        uv = [None if part.failure else _corners(part.flattening.uv) for part in result.parts]
        placed = [_corners(part.mesh.uv) if own is not None else None for part, own in zip(result.scene.parts, uv)]
        report = self._call(self._papilla.measure_scene, result.scene)
        return Unwrapped(placed, [part.failure for part in result.parts], result.charts,
                         [part.method for part in result.parts], self._summary(report.report))

    def measure(self, meshes, normalize, progress=None):
        scene = self._scene(meshes)
        report = self._call(self._papilla.measure_scene, scene, normalize=normalize).report
        each = report.per_triangle
        return Distortion(each["area_mm2"].copy(), each["symmetric_dirichlet"].copy(), each["stretch_l2"].copy(),
                          each["flipped"].copy(), each["measured"].copy(), self._summary(report))

    def bake(self, scene, rules, output, progress=None):
        if self._library:
            read = self._call(self._papilla.read_materials, rules, self._library)
        else:
            read = self._call(self._papilla.read_materials, rules)
        result = self._call(self._papilla.bake_file, scene, output, read, progress=progress)
        problems = [use.problem for use in result.plan.rules if use.problem]
        return Baked(len(result.surfaces), [*result.scene.losses, *problems, *result.scene.warnings])

    def _scene(self, meshes):
        pa = self._papilla
        parts = [pa.Part(name=clean_name(m.name), mesh=self._call(pa.mesh, m.positions, m.triangles, m.uv)) for m in meshes]
        nodes = [pa.Node(name=part.name, part=i) for i, part in enumerate(parts)]
        return pa.Scene(format="Blender", unit="mm", millimetres_per_unit=1.0, up="z", parts=parts, nodes=nodes,
                        roots=np.arange(len(nodes), dtype=np.int32))

    def _method(self, settings):
        """The options by the reader of MATERIALS.json, which knows their names and limits."""
        pa = self._papilla
        if settings.method == unwrap_options.ENVIRONMENT:
            given = {"map": settings.options.get("environment_map"), "eye": settings.options.get("eye")}
            method = self._call(pa.MethodOptions, method="environment",
                                environment={k: v for k, v in given.items() if v is not None})
        else:
            method = self._read_options({"method": settings.method, **settings.options})
        method.effort = settings.effort
        return method

    def _read_options(self, unwrap):
        with tempfile.TemporaryDirectory(prefix="papilla-") as folder:
            path = pathlib.Path(folder) / "materials.json"
            path.write_text(json.dumps({"materials": {"all": {"unwrap": unwrap}}}), encoding="utf-8")
            try:
                return self._papilla.read_materials(path).materials["all"].unwrap_options
            except self._papilla.Error as error:
                text = re.sub(r"^.*/unwrap/?", "", str(error))
                raise EngineError(f"{unwrap['method']}: {text}") from error

    def _call(self, function, *arguments, **keywords):
        if keywords.get("progress", True) is None:
            del keywords["progress"]
        try:
            return function(*arguments, **keywords)
        except self._papilla.Cancelled as error:
            raise Cancelled from error
        except (self._papilla.Error, TypeError) as error:
            raise EngineError(str(error)) from error

    def _summary(self, report):
        names = ("triangles", "charts", "flipped", "overlap_area_fraction", "stretch_l2", "stretch_linf", "seam_length_mm")
        numbers = {name: getattr(report, name) for name in names}
        for name in ("symmetric_dirichlet", "angle_error_deg"):
            numbers[name] = {"mean": getattr(report, name).mean, "max": getattr(report, name).max}
        numbers["area_ratio"] = {"min": report.area_ratio.min, "max": report.area_ratio.max}
        return summary_of(numbers)


def _corners(uv):
    """The values of a CornerVec2 per corner."""
    return np.asarray(uv.values, float)[np.asarray(uv.indices)]


def _library_entry(told):
    backing, relief, look = told.backing, told.relief, told.appearance
    return LibraryEntry(
        told.id, told.name_en, tuple(told.uses.en), told.stiffness.value, told.damping.value,
        told.static_friction.value, told.dynamic_friction.value, told.stribeck_velocity.value,
        (backing.stiffness.value, backing.depth_mm.value) if backing else None,
        tuple(side.value for side in relief.size_mm) if relief else None, relief.depth_mm.value if relief else None,
        look.color.value, look.roughness.value, look.metallic.value)
