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
///   - the probe's path since the last tick, on which the proxy was free as well, went through a triangle; and every
///     free tick after that until the path goes through one again or the proxy gets hold.
/// noexcept, no allocation; a tick in contact costs nothing, a free one a query near the surface.
class ContactAudit {
 public:
  explicit ContactAudit(const ContactSurface& surface) noexcept : surface_(&surface) {}

  /// True when this tick is lost. Call it every tick with what the proxy says.
  bool lost(Vec3 probe, bool in_contact) noexcept;

 private:
  const ContactSurface* surface_;
  Vec3 last_;
  bool was_free_ = false, beyond_ = false;
};

}  // namespace papilla
