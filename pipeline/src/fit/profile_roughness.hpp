// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/pipeline/fit_material.hpp"

namespace papilla {

/// A place of the surface that the probe slid over, its way along the surface so far, and the normal there.
struct ProfilePoint {
  double way_m = 0;
  Vec3 place_m, normal;
};

/// What profile_roughness() finds; where something is missing, why.
struct ProfileRoughness {
  std::optional<FittedRoughness> roughness;
  std::string no_roughness, no_hurst;
};

/// Roughness of the runs that a probe slid straight on; see fit_material().
/// @param noise_m standard deviation of the heights' noise.
ProfileRoughness profile_roughness(const std::vector<std::vector<ProfilePoint>>& runs, double noise_m);

}  // namespace papilla
