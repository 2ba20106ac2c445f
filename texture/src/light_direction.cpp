// SPDX-License-Identifier: MIT
#include "papilla/texture/light_direction.hpp"

#include <cmath>

#include "checks.hpp"
#include "papilla/core/units.hpp"
#include "papilla/texture/stored_samples.hpp"
#include "structure_tensor.hpp"

namespace papilla {

LightEstimate estimate_light(const GreyImage& image) {
  texture_detail::require_image(image, "estimate_light");
  return estimate_light(SamplesInMemory(image.pixels, image.width, image.height));
}

LightEstimate estimate_light(const SampleRows& picture) {
  const texture_detail::StructureTensor tensor = texture_detail::structure_tensor(picture);
  LightEstimate estimate;
  estimate.coherence = tensor.coherence();
  if (!(estimate.coherence > 0)) return estimate;
  Vec2 azimuth{std::cos(tensor.angle()), std::sin(tensor.angle())};
  constexpr double k_horizontal = 1e-6;
  if (azimuth.y > k_horizontal || (std::abs(azimuth.y) <= k_horizontal && azimuth.x > 0)) azimuth = -1.0 * azimuth;
  const double elevation = estimate.elevation_deg * k_radians_per_degree;
  estimate.direction = {std::cos(elevation) * azimuth.x, std::cos(elevation) * azimuth.y, std::sin(elevation)};
  return estimate;
}

}  // namespace papilla
