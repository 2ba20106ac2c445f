// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

/// What each source file adds to the module.
namespace papilla::python {

namespace py = pybind11;

// Generated from the headers: structs and enumerations.
void add_scenes_records(py::module_& module);
void add_meshing_records(py::module_& module);
void add_param_records(py::module_& module);
void add_texture_records(py::module_& module);
void add_procedural_records(py::module_& module);
void add_pipeline_records(py::module_& module);
void add_haptic_records(py::module_& module);

// Classes that are no plain structs.
void add_pictures(py::module_& module);
void add_corner_attributes(py::module_& module);
void add_recipe_classes(py::module_& module);
void add_sourced_values(py::module_& module);

// Functions.
void add_scenes(py::module_& module);
void add_meshing(py::module_& module);
void add_param(py::module_& module);
void add_texture(py::module_& module);
void add_procedural(py::module_& module);
void add_materials(py::module_& module);
void add_pipeline(py::module_& module);
void add_haptic(py::module_& module);

}  // namespace papilla::python
