// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "papilla/core/vec.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {

/// Watches a proxy and tells the ticks on which it has lost its contact. Shares no contact code with the proxy: it asks
/// for the closest base point and for crossings of straight ways with the triangles.
///
/// A tick is lost when
///   - the proxy has gone through a triangle: neither the straight way from where it was to where it is nor the one
///     along its turns is free of them. Whatever the turns are said to be, a free way is one; around the rim of an open
///     sheet there is such a way, however far that is;
///   - it is free although it has gone through triangles an odd number of times since the audit began;
///   - it is free and not at the probe;
///   - it is free although the probe stands in front of its closest triangle, but lower than the relief and probe
///     radius above it.
/// noexcept, no allocation. Costs one segment query, one for each turn where that meets a triangle, and one closest
/// point when free near the surface.
class ContactAudit {
 public:
  explicit ContactAudit(const ContactSurface& surface) noexcept : surface_(&surface) {}

  /// True when this tick is lost. Call it every tick with what the proxy says: state() and turns().
  bool lost(Vec3 probe, const ProxyState& state, std::span<const Vec3> turns) noexcept;

 private:
  const ContactSurface* surface_;
  Vec3 proxy_;  // Of the tick before.
  bool started_ = false, behind_ = false;

  int crossings(Vec3 to, std::span<const Vec3> turns) const noexcept;
};

}  // namespace papilla
