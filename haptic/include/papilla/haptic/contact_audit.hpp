// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "papilla/core/vec.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {

/// Detects ticks on which a proxy lost its contact, independently of the proxy's code: it uses only the closest base
/// point and the crossings of segments with the triangles.
///
/// A tick is lost when
///   - the proxy passed a triangle: neither the segment from its last position to the new one nor the path along its
///     waypoints is free of crossings. Any free path is accepted, so going around the rim of an open sheet is no loss;
///   - it is free although it passed triangles an odd number of times since the start;
///   - it is free and not at the probe;
///   - it is free although the probe is in front of its closest triangle and lower than relief and probe radius above
///   it.
/// noexcept, no allocation. Cost: one segment query; one per waypoint when that crosses a triangle; one closest point
/// when the proxy is free near the surface.
class ContactAudit {
 public:
  explicit ContactAudit(const ContactSurface& surface) noexcept : surface_(&surface) {}

  /// Call it every tick with Proxy::state() and Proxy::waypoints(). @returns true when the tick is lost.
  bool update(Vec3 probe, const ProxyState& state, std::span<const Vec3> waypoints) noexcept;

 private:
  const ContactSurface* surface_;
  Vec3 proxy_;                             // Of the tick before.
  bool started_ = false, inside_ = false;  // inside_: after an odd number of crossings.

  int crossings(Vec3 to, std::span<const Vec3> waypoints) const noexcept;
};

}  // namespace papilla
