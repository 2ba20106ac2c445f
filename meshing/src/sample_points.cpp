// SPDX-License-Identifier: MIT
#include "sample_points.hpp"

#include <cmath>

#include "papilla/core/error.hpp"

namespace papilla::detail {

void check_volume(const Volume& volume, const std::string& function) {
  if (const auto* box = std::get_if<BoxVolume>(&volume)) {
    const bool ordered = box->low.x <= box->high.x && box->low.y <= box->high.y && box->low.z <= box->high.z;
    if (!ordered || !is_finite(box->low) || !is_finite(box->high))
      throw InvalidInput(function + ": the box is not finite or its low corner exceeds its high one");
  } else {
    const auto& sphere = std::get<SphereVolume>(volume);
    if (!is_finite(sphere.centre) || !std::isfinite(sphere.radius_mm) || sphere.radius_mm < 0)
      throw InvalidInput(function + ": the sphere is not finite or has a negative radius");
  }
}

}  // namespace papilla::detail
