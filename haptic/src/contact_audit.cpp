// SPDX-License-Identifier: MIT
#include "papilla/haptic/contact_audit.hpp"

#include <cmath>
#include <numbers>

namespace papilla {
namespace {

constexpr double k_detours[] = {0.125, 0.25, 0.5, 0.75, 1, 1.5, 2};  // Of the distance,
constexpr double k_lifts[] = {0, 0.25};                              // and off the surface,
constexpr int k_directions = 8;                                      // in each of these around it.

}  // namespace

bool ContactAudit::way_around(Vec3 to) const noexcept {
  const double distance = norm(to - held_at_);
  // A proxy on the very rim is drawn straight against it, and may slip off to either side.
  const Vec3 axis = std::abs(held_by_.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 first = normalized(cross(held_by_, axis)), second = cross(held_by_, first);
  for (int i = 0; i < k_directions; ++i) {
    const double angle = 2 * std::numbers::pi * i / k_directions;
    const Vec3 along = std::cos(angle) * first + std::sin(angle) * second;
    for (const double detour : k_detours)
      for (const double lift : k_lifts) {
        const Vec3 turn = held_at_ + distance * detour * (along + lift * held_by_);
        if (surface_->crossings(held_at_, turn) == 0 && surface_->crossings(turn, to) == 0) return true;
      }
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
