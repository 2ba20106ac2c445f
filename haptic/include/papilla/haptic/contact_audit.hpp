// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/vec.hpp"
#include "papilla/haptic/contact_surface.hpp"

namespace papilla {

/// Watches a proxy and tells the ticks on which it has lost its contact. Shares no contact code with the proxy: it asks
/// for the closest base point and for crossings of the probe's own path with the triangles.
///
/// A tick is lost when the proxy is free although
///   - the probe stands in front of its closest triangle, but lower than the relief and probe radius above it; or
///   - the probe's path since the last reset has gone through the triangles an odd number of times: it is behind a wall
///     without being held. Leaving around the rim of an open sheet that it was pressed through counts as lost, too,
///     from there on: the audit errs on that side.
/// noexcept, no allocation. Costs one segment query, and one closest point when free near the surface.
class ContactAudit {
 public:
  explicit ContactAudit(const ContactSurface& surface) noexcept : surface_(&surface) {}

  /// True when this tick is lost. Call it every tick with what the proxy says.
  bool lost(Vec3 probe, bool in_contact) noexcept;

 private:
  const ContactSurface* surface_;
  Vec3 last_;
  bool started_ = false, behind_ = false;
};

}  // namespace papilla
