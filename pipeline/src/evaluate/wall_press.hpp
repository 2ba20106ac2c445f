// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/haptic/device.hpp"

namespace papilla {

/// A wall that a device is pressed against, and how it is stabilized.
struct WallPress {
  double stiffness = 500, damping = 0;  ///< As asked for: N/m, N·s/m.
  double rate_hz = 1000;                ///< Of the loop.
  double seconds = 3;                   ///< About from the first contact on.
  bool clamp = false, control = false;  ///< clamp_to_stable(), control_passivity().
};

/// What the hand experienced.
struct WallResponse {
  double rest_speed_m_per_s = 0;  ///< Rms over the last 0.3 s, in which the hand should be at rest.
  double largest_force_n = 0;
  double stiffness = 0, damping = 0;  ///< As rendered: those asked for, or clamped.
  std::vector<double> given_j;        ///< Largest energy given to the hand so far, at the end of every tick.
};

/// The hand is at rest below this speed.
inline constexpr double k_still_m_per_s = 1e-2;

/// A light hand presses on the wall at half a metre a second and stays there: the player's whole tick with a SimDevice.
/// Deterministic. Cost: some microseconds a tick.
WallResponse press_wall(const DeviceCaps& device, const WallPress& press);

}  // namespace papilla
