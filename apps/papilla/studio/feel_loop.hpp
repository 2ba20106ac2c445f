// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/device.hpp"
#include "studio/hand_path.hpp"

namespace papilla::app {

inline constexpr double k_feel_rate_hz = 1000;

/// A tick, in metres and newtons in the frame of the surface.
struct FeelRow {
  double t = 0;  ///< s, of the path.
  Vec3 hand, probe, proxy, force;
  Vec3 normal;  ///< Unit, in which the surface holds the proxy; zero without contact.
  bool in_contact = false;
};

/// What is new since the last batch.
struct FeelBatch {
  static constexpr std::size_t k_ticks = 16;  ///< About 60 batches a second.
  std::vector<FeelRow> rows;
  std::vector<float> sound;  ///< Vibration of the ticks, m/s².
  std::uint64_t late = 0;    ///< Ticks so far that began more than a period late.
};

/// Of the sound: enough for its band, which ends at 1 kHz, and the least that a browser plays.
inline constexpr double k_feel_sound_hz = 8000;

enum class FeelEnd {
  lifted,   ///< The pointer was.
  silent,   ///< Nothing more came of the path.
  stopped,  ///< By `stops`.
  fault,    ///< The guard stopped the force.
};

/// The contact of a player, 1000 times a second, with a simulated device whose hand goes along `path` as it comes in:
/// SimDevice, HapticTick and Vibration, so that a player on the same surface and device gives the same forces. Each
/// tick begins when it is due; where the machine was not in time the next ones follow at once, so that no tick is left
/// out. The hand is played 30 ms after it moved, which bridges the pauses between messages.
/// @param surface whose materials are stable for the device. @pre path.is_begun().
FeelEnd run_feel_loop(const ContactSurface& surface, const DeviceCaps& device, HandPath& path,
                      const std::function<void(const FeelBatch&)>& tell, const std::atomic<bool>& stops);

}  // namespace papilla::app
