// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/haptic/real_part.hpp"
#include "papilla/io/haptic_scene.hpp"

namespace papilla::player {

/// What is known of a real part under the device.
struct RealSurface {
  std::vector<double> touched;      ///< Centres of the tip at three points, x y z each, m, in the device's frame.
  std::vector<double> part_points;  ///< The same points of the part, in the scene's frame; empty: it is a plane.
  double press_n = 1;               ///< RealPartOptions::press_n.
};

/// Where the part stands. A plane is laid on the scene at the middle of its largest tagged surface.
/// @throws InvalidInput when the points tell no place, are not those of the part, or lie far from its surface.
Registration register_part(const RealSurface& real, const HapticScene& scene, const ContactSurface& surface);

}  // namespace papilla::player
