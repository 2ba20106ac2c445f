// SPDX-License-Identifier: MIT
#include "papilla/texture/roughness.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "checks.hpp"
#include "papilla/texture/best_dimension.hpp"

namespace papilla {

double rms_height_mm(const HeightMap& relief) {
  texture_detail::require_height_map(relief, "rms_height_mm", false);
  double sum = 0, squares = 0;
  for (const float height : relief.mm) sum += static_cast<double>(height);
  const double mean = sum / static_cast<double>(relief.mm.size());
  for (const float height : relief.mm)
    squares += (static_cast<double>(height) - mean) * (static_cast<double>(height) - mean);
  return std::sqrt(squares / static_cast<double>(relief.mm.size()));
}

Roughness measure_roughness(const HeightMap& relief, const RoughnessOptions& options) {
  texture_detail::require_height_map(relief, "measure_roughness", true);
  Roughness roughness;
  roughness.rms_mm = rms_height_mm(relief);
  roughness.shortest_wavelength_mm = 2 * std::max(relief.pitch_mm_x, relief.pitch_mm_y);
  roughness.longest_wavelength_mm = std::min(relief.width * relief.pitch_mm_x, relief.height * relief.pitch_mm_y);
  constexpr int k_least_side = 32;
  if (!options.dimension || std::min(relief.width, relief.height) < k_least_side) return roughness;
  BestDimension best = best_dimension({relief.width, relief.height, relief.mm, 0, 32});
  roughness.fractal = std::move(best.estimate);
  roughness.reason = std::move(best.reason);
  return roughness;
}

}  // namespace papilla
