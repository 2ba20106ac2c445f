// SPDX-License-Identifier: MIT
#include "papilla/haptic/real_part.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla {

RealPart::RealPart(const ContactSurface& surface, const Pose& to_part, const RealPartOptions& options)
    : surface_(&surface), to_part_(to_part), options_(options) {
  if (!(options.press_n >= 0) || !std::isfinite(options.press_n))
    throw InvalidInput("RealPart: a load of " + std::to_string(options.press_n) + " N is not 0 or more");
  if (!(options.reach_m > 0) || !std::isfinite(options.reach_m))
    throw InvalidInput("RealPart: a reach of " + std::to_string(options.reach_m) + " m is not positive");
}

Vec3 RealPart::force(Vec3 tip) noexcept {
  state_ = {};
  state_.proxy = tip;
  const Vec3 place = to_part_(tip);
  const double radius = surface_->probe_radius_m();
  const auto near = surface_->closest_point(place, radius + options_.reach_m + surface_->tallest_relief_m());
  if (!near) return {};
  const Vec3 n = near->face_normal;
  const double gap = dot(place - near->point, n) + near->base_m - radius;
  const double beyond = std::clamp(2 * std::abs(gap) / options_.reach_m - 1, 0.0, 1.0);
  const double share = 1 - beyond * beyond * (3 - 2 * beyond);
  if (!(share > 0)) return {};
  const double stiffness = surface_->material(near->material).stiffness;
  const double spring = stiffness * (near->height_m + near->base_m);
  const Vec3 force = share * (spring * n - std::max(0.0, options_.press_n + spring) * near->slope);
  state_.normal = state_.shaded_normal = to_part_.turned_back(n);
  state_.proxy = tip - gap * state_.normal;
  state_.in_contact = true;
  state_.material = near->material;
  return to_part_.turned_back(force);
}

}  // namespace papilla
