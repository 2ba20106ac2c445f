// SPDX-License-Identifier: MIT
#include "papilla/haptic/contact_audit.hpp"

namespace papilla {

bool ContactAudit::lost(Vec3 probe, bool in_contact) noexcept {
  if (in_contact) {
    was_free_ = beyond_ = false;
    return false;
  }
  if (was_free_ && surface_->crosses(last_, probe)) beyond_ = !beyond_;
  last_ = probe;
  was_free_ = true;
  if (beyond_) return true;

  const double radius = surface_->probe_radius_m();
  const auto near = surface_->closest_point(probe, radius + surface_->tallest_relief_m());
  if (!near || near->on_border || dot(probe - near->point, near->face_normal) < 0) return false;
  return near->distance_m < radius + near->height_m - surface_->tolerance_m();
}

}  // namespace papilla
