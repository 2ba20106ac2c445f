// SPDX-License-Identifier: MIT
#include "papilla/haptic/contact_audit.hpp"

namespace papilla {

bool ContactAudit::lost(Vec3 probe, bool in_contact) noexcept {
  if (!is_finite(probe)) return false;
  if (started_ && surface_->crossings(last_, probe) % 2 == 1) behind_ = !behind_;
  last_ = probe;
  started_ = true;
  if (in_contact) return false;
  if (behind_) return true;

  const double radius = surface_->probe_radius_m();
  const auto near = surface_->closest_point(probe, radius + surface_->tallest_relief_m());
  if (!near || near->on_border || dot(probe - near->point, near->face_normal) < 0) return false;
  return near->distance_m < radius + near->height_m - surface_->tolerance_m();
}

}  // namespace papilla
