// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/vec.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {

/// Watches a proxy and tells the ticks on which it has lost its contact. Shares no contact code with the proxy: it asks
/// for the closest base point and for crossings of straight ways with the triangles.
///
/// A tick is lost when the proxy is free although
///   - the probe stands in front of its closest triangle, but lower than the relief and probe radius above it; or
///   - the probe's path since the last reset has gone through the triangles an odd number of times: it is behind a wall
///     without being held. That is forgiven when the proxy comes free around the rim of an open sheet: when from where
///     it was held a tick ago two straight pieces that meet no triangle lead to where it is now, the first along the
///     surface in one of eight directions, at most twice as long as the distance. Around a closed surface there is no
///     such way; through a sheet, farther than that from its rim, neither.
/// noexcept, no allocation. Costs one segment query, and one closest point when free near the surface; up to 224
/// segment queries more in the one tick in which the proxy comes free behind a wall, among two million triangles 0.2 ms
/// when no way around is found.
class ContactAudit {
 public:
  explicit ContactAudit(const ContactSurface& surface) noexcept : surface_(&surface) {}

  /// True when this tick is lost. Call it every tick with what the proxy says.
  bool lost(Vec3 probe, const ProxyState& state) noexcept;

 private:
  const ContactSurface* surface_;
  Vec3 last_;
  bool started_ = false, behind_ = false;
  bool held_ = false;       // In the tick before,
  Vec3 held_at_, held_by_;  // there, along this normal.

  bool way_around(Vec3 to) const noexcept;
};

}  // namespace papilla
