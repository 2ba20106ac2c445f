// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/haptic/device.hpp"

namespace papilla {

/// A wall that a device is pressed against, and what keeps it from shaking the hand.
struct WallPress {
  double stiffness = 500, damping = 0;  ///< As asked for: N/m, N·s/m.
  double rate_hz = 1000;                ///< Of the loop.
  double seconds = 3;                   ///< From the first contact on, nearly.
  bool clamp = false, control = false;  ///< clamp_to_stable(), control_passivity().
};

struct WallFelt {
  double rest_speed_m_per_s = 0;  ///< Root mean square over the last 0.3 s, when the hand should rest.
  double largest_force_n = 0;
  double stiffness = 0, damping = 0;  ///< That were felt.
  std::vector<double> given_j;        ///< Most energy that the hand had been given, at the end of every tick.
};

/// Speeds above this are no rest.
inline constexpr double k_still_m_per_s = 1e-2;

/// A light hand comes down on the wall at half a metre a second and rests there: the whole tick of the player against a
/// SimDevice. Deterministic. Cost: some microseconds a tick.
WallFelt press_wall(const DeviceCaps& device, const WallPress& press);

}  // namespace papilla
