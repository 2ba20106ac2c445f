// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "json/json.hpp"
#include "papilla/pipeline/fit_material.hpp"

namespace papilla::app {

/// {stiffness, damping, static_friction, dynamic_friction, stribeck_velocity, each {value, low, high} or null;
/// roughness{rms_mm{}, hurst{}, dimension{}, wavelength_range_mm[]}; not_identified[] {parameter, reason}; surface,
/// normal[], rms_residual_n, samples, outliers, slip_m_per_s[], stop, trace[], warnings[]}.
Json fit_json(const std::string& stroke, const MaterialFit& fit);

/// MATERIALS.json with the material and one rule that gives it to every part. What is not identified is left out; what
/// the file has no place for (intervals, roughness) stands in the material's "$comment".
Json fitted_materials_json(const std::string& stroke, const std::string& material, const MaterialFit& fit);

}  // namespace papilla::app
