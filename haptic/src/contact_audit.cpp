// SPDX-License-Identifier: MIT
#include "papilla/haptic/contact_audit.hpp"

namespace papilla {

/// Crossings of the proxy's path with triangles; 0 when the straight segment is free.
int ContactAudit::crossings(Vec3 to, std::span<const Vec3> waypoints) const noexcept {
  if (surface_->crossings(proxy_, to) == 0) return 0;
  int sum = 0;
  Vec3 from = proxy_;
  for (const Vec3& waypoint : waypoints) {
    sum += surface_->crossings(from, waypoint);
    from = waypoint;
  }
  return sum + surface_->crossings(from, to);
}

bool ContactAudit::update(Vec3 probe, const ProxyState& state, std::span<const Vec3> waypoints) noexcept {
  if (!ContactSurface::is_valid_position(probe)) return false;
  const int crossed = started_ ? crossings(state.proxy, waypoints) : 0;
  proxy_ = state.proxy;
  started_ = true;
  if (crossed % 2 == 1) inside_ = !inside_;
  if (crossed > 0) return true;
  if (state.in_contact) return false;
  if (inside_ || norm(probe - state.proxy) > surface_->tolerance_m()) return true;

  const double radius = surface_->probe_radius_m();
  const auto near = surface_->closest_point(probe, radius + surface_->tallest_relief_m());
  if (!near || near->on_border || dot(probe - near->point, near->face_normal) < 0) return false;
  return near->distance_m < radius + near->height_m - surface_->tolerance_m();
}

}  // namespace papilla
