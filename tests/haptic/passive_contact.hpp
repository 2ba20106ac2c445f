// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"

namespace papilla::testing {

struct PortEnergy {
  double least_j = 0;    ///< Of the hand's work, from rest.
  double largest_v = 0;  ///< m/s, of the handle.
  double contact_share = 0;
  double limit = 0;  ///< N/m, the stiffness that passivity allows.
};

/// A hand that taps on, presses into and lets go of a wall of `share` times the largest stable stiffness.
inline PortEnergy wall_contact(const DevicePreset& preset, double share, double seconds, std::uint64_t seed) {
  const double period = 1e-3;
  const DeviceCaps caps = preset.caps();
  PortEnergy energy;
  energy.limit = stiffness_limit(caps.dynamics, period, 0);
  ContactMaterial wall;
  wall.stiffness = share * energy.limit;
  const ContactSurface surface(plate(1, 1, 0.2, 0.2), {wall}, {}, 0);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> depth(-2e-3, 3e-3), pause(0.02, 0.4);
  std::vector<Trajectory::Sample> samples{{0, {0.1, 0.1, 2e-3}}};
  while (samples.back().t < seconds) samples.push_back({samples.back().t + pause(random), {0.1, 0.1, -depth(random)}});
  const Trajectory hand(std::move(samples));
  // A light hand: what it damps is what would hide an unstable wall.
  SimDevice device(caps, hand, period, {.stiffness = 100, .damping = 0.1});
  SafetyLimits limits = safety_limits(1e6);
  limits.soft_start_s = 0;
  HapticTick tick(surface, limits, period);
  const auto ticks = static_cast<int>(seconds / period);
  int contact = 0;
  for (int i = 0; i < ticks; ++i) {
    DeviceState state;
    device.read(state);
    device.write(tick(state));
    contact += tick.proxy().in_contact;
    energy.least_j = std::min(energy.least_j, device.hand_work_j());
  }
  energy.contact_share = static_cast<double>(contact) / ticks;
  return energy;
}

/// Speed of the handle, root mean square over the last 0.3 s, after a hand that is only a spring has come down on a
/// wall at half a metre a second and kept pressing for eight seconds: zero when the wall is stable, else it keeps
/// bouncing.
inline double speed_at_rest(const DevicePreset& preset, double share) {
  const double period = 1e-3;
  const DeviceCaps caps = preset.caps();
  ContactMaterial wall;
  wall.stiffness = share * stiffness_limit(caps.dynamics, period, 0);
  const ContactSurface surface(plate(1, 1, 0.2, 0.2), {wall}, {}, 0);
  const Trajectory hand(std::vector<Trajectory::Sample>{{0, {0.1, 0.1, 5e-3}}, {0.03, {0.1, 0.1, -1e-2}}});
  SimDevice device(caps, hand, period, {.stiffness = 0.5 * wall.stiffness / share, .damping = 0});
  SafetyLimits limits = safety_limits(1e6);
  limits.soft_start_s = 0;
  HapticTick tick(surface, limits, period);
  double sum = 0;
  constexpr int ticks = 8000, last = 300;
  for (int i = 0; i < ticks; ++i) {
    DeviceState state;
    device.read(state);
    device.write(tick(state));
    if (i >= ticks - last) sum += dot(device.velocity(), device.velocity());
  }
  return std::sqrt(sum / last);
}

}  // namespace papilla::testing
