// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "json/json.hpp"
#include "papilla/pipeline/material_library.hpp"
#include "papilla/pipeline/material_suggestion.hpp"

namespace papilla::app {

/// {name (the id), names{en, de}, category, categories{}, aliases[], uses{}, stiffness, damping, static_friction,
/// dynamic_friction, stribeck_velocity, youngs_modulus, backing{stiffness, depth_mm}, height{recipe|grain|picture,
/// size_mm, depth_mm}, roughness{hurst, rms, wavelength_range}, appearance{color, roughness, metallic}, sources{key:
/// citation or "estimated"}, notes{key: note}}; null for what the material does not have.
Json library_material_json(const LibraryMaterial& material);

/// {checked, cited, estimated, problems[] {file, reason}}.
Json library_check_json(const LibraryCheck& check);

/// {part, material, reason} a suggestion; the material as MATERIALS.json names it.
Json suggestions_json(const std::vector<MaterialSuggestion>& suggestions);

}  // namespace papilla::app
