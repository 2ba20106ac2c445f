// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/sim_device.hpp"

namespace papilla::bench {

/// What a random hand on a simulated device met, tick by tick.
struct SoakRun {
  std::uint64_t ticks = 0, contact_ticks = 0, lost = 0, not_finite = 0, too_strong = 0, too_steep = 0, faults = 0;
  double largest_share = 0;           ///< Of the device's largest force.
  double longest_step = 0;            ///< Change of the force in a tick over what is allowed, while a contact goes on.
  std::uint64_t episodes = 0;         ///< From one free flight to the next.
  std::uint64_t active_episodes = 0;  ///< Those that gave the hand over 1 µJ more than it had put in.
  double put_in_j = 0, returned_j = 0;  ///< Work of the hand on the device while in contact, positive and negative.
  double least_kept_j = 0;              ///< Least energy that device and wall kept of an episode.
  double least_kept_share = 1;          ///< The same over what was put in, of the episodes with more than a microjoule.

  void add(const SoakRun& other) noexcept;
};

/// A hand that for `seconds` goes to random places of the surface, presses up to 3 mm deep, strokes, taps, vibrates,
/// rests, plunges and leaves again, at 0.02 to 0.5 m/s.
Trajectory random_hand(const ContactSurface& surface, std::uint64_t seed, double seconds);

/// That hand on the device at 1 kHz, with everything between position and force that the player has.
/// @param surface stable for the device.
SoakRun soak(const ContactSurface& surface, const DevicePreset& device, std::uint64_t seed, double seconds);

}  // namespace papilla::bench
