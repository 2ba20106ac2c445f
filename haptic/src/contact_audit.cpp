// SPDX-License-Identifier: MIT
#include "papilla/haptic/contact_audit.hpp"

namespace papilla {

/// How often the proxy's way goes through triangles. Where the straight one is free, the turns don't matter.
int ContactAudit::crossings(Vec3 to, std::span<const Vec3> turns) const noexcept {
  if (surface_->crossings(proxy_, to) == 0) return 0;
  int sum = 0;
  Vec3 from = proxy_;
  for (const Vec3& turn : turns) {
    sum += surface_->crossings(from, turn);
    from = turn;
  }
  return sum + surface_->crossings(from, to);
}

bool ContactAudit::lost(Vec3 probe, const ProxyState& state, std::span<const Vec3> turns) noexcept {
  if (!ContactSurface::is_place(probe)) return false;
  const int through = started_ ? crossings(state.proxy, turns) : 0;
  proxy_ = state.proxy;
  started_ = true;
  if (through % 2 == 1) behind_ = !behind_;
  if (through > 0) return true;
  if (state.in_contact) return false;
  if (behind_ || norm(probe - state.proxy) > surface_->tolerance_m()) return true;

  const double radius = surface_->probe_radius_m();
  const auto near = surface_->closest_point(probe, radius + surface_->tallest_relief_m());
  if (!near || near->on_border || dot(probe - near->point, near->face_normal) < 0) return false;
  return near->distance_m < radius + near->height_m - surface_->tolerance_m();
}

}  // namespace papilla
