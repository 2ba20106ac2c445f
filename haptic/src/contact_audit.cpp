// SPDX-License-Identifier: MIT
#include "papilla/haptic/contact_audit.hpp"

namespace papilla {
namespace {

constexpr double k_detours[] = {0.125, 0.25, 0.5, 0.75, 1, 1.5, 2};  // Of the distance,
constexpr double k_lifts[] = {0, 0.25};                              // and off the surface.

}  // namespace

bool ContactAudit::way_around(Vec3 to) const noexcept {
  const Vec3 way = to - held_at_, along = way - dot(way, held_by_) * held_by_;
  if (!(norm(along) > 0)) return false;
  const double distance = norm(way);
  for (const double detour : k_detours)
    for (const double lift : k_lifts) {
      const Vec3 turn = held_at_ + distance * (detour * normalized(along) + lift * detour * held_by_);
      if (surface_->crossings(held_at_, turn) == 0 && surface_->crossings(turn, to) == 0) return true;
    }
  return false;
}

bool ContactAudit::lost(Vec3 probe, const ProxyState& state) noexcept {
  if (!ContactSurface::is_place(probe)) return false;
  if (started_ && surface_->crossings(last_, probe) % 2 == 1) behind_ = !behind_;
  last_ = probe;
  started_ = true;
  if (state.in_contact) {
    held_ = true;
    held_at_ = state.proxy;
    held_by_ = state.normal;
    return false;
  }
  if (behind_ && held_ && way_around(probe)) behind_ = false;
  held_ = false;
  if (behind_) return true;

  const double radius = surface_->probe_radius_m();
  const auto near = surface_->closest_point(probe, radius + surface_->tallest_relief_m());
  if (!near || near->on_border || dot(probe - near->point, near->face_normal) < 0) return false;
  return near->distance_m < radius + near->height_m - surface_->tolerance_m();
}

}  // namespace papilla
