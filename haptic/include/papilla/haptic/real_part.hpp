// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"
#include "papilla/haptic/registration.hpp"

namespace papilla {

/// Options of RealPart.
struct RealPartOptions {
  double press_n = 1;     ///< P, the load of the hand on the part, which no device measures; ≥ 0.
  double reach_m = 1e-3;  ///< From this distance of the tip from the part on there is no force; > 0.
};

/// What a device adds to the touch of a real, milled part whose surface is that of a scene without its relief: the part
/// holds the tip, the device gives the deviation of the texture alone. With b the point of the surface that is nearest
/// to the tip, n its normal, h the height of the relief there over the part (dilated by the tip, of either sign), k the
/// material's stiffness, and
///     U(b) = (P + k·h)² / 2k,
/// the energy of a spring that the hand presses in by P/k on the smooth part,
///     F = w·(k·h·n − max(0, P + k·h)·∇h),
/// the change of the part's own force by the texture and the slope of U. Across the surface there is no force but that;
/// along n only what differs from the part's own. w is 1 up to half of the reach and falls smoothly to 0 at the reach,
/// so that a tip that is lifted feels nothing and a registration that is off by less than half of it is no force.
/// Friction and damping are the part's own.
///
/// noexcept, no allocation, never NaN for finite places. Cost: a closest point a tick. Breaks down where the part is
/// more sharply curved than the tip, and where the registration is off by more than half of the reach.
class RealPart {
 public:
  /// @param surface must outlive the object. @throws InvalidInput when an option is out of its range.
  RealPart(const ContactSurface& surface, const Pose& to_part, const RealPartOptions& options = {});

  /// Force in newtons on a tip whose centre is there, both in the device's frame.
  Vec3 force(Vec3 tip) noexcept;

  /// Of the last force(): the place on the part in the device's frame as proxy, whether there was one, its material.
  const ProxyState& state() const noexcept { return state_; }

 private:
  const ContactSurface* surface_;
  Pose to_part_;
  RealPartOptions options_;
  ProxyState state_;
};

}  // namespace papilla
