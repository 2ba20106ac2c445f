// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/device.hpp"
#include "papilla/haptic/histogram.hpp"
#include "papilla/haptic/latest_slot.hpp"
#include "papilla/haptic/safety.hpp"
#include "papilla/haptic/trajectory.hpp"

namespace papilla {

/// One tick of a recording.
struct RecordRow {
  double t = 0;  ///< s
  Vec3 hand, probe, proxy, force;
  bool in_contact = false;
};

/// What the loop is doing now, for other threads to look at. The numbers are from about the same tick.
struct LoopStatus {
  std::atomic<std::uint64_t> ticks{0}, contact_ticks{0}, lost_contact_ticks{0}, missed_deadlines{0};
  std::atomic<double> force_n{0}, tick_us{0}, wakeup_us{0};
};

struct LoopOptions {
  double rate_hz = 1000;
  std::uint64_t ticks = 2000;
  bool control_passivity = false;    ///< See PassivityController.
  double watchdog_s = 0.01;          ///< Age of the newest position from which on there is no force.
  bool paced = true;                 ///< False: ticks follow each other at once (tests, replays faster than time).
  const Trajectory* hand = nullptr;  ///< For the recording's hand columns; without it they repeat the probe.
  std::vector<RecordRow>* record = nullptr;  ///< Filled with one row a tick; its memory is taken before the loop.
  LoopStatus* status = nullptr;              ///< Kept up to date, lock-free.
  LatestSlot<RecordRow>* latest = nullptr;   ///< Gets every tick, for other threads to look at the newest.
  const std::atomic<bool>* stop = nullptr;   ///< The loop ends at the next tick when it is true.
};

struct LoopResult {
  std::uint64_t ticks = 0, missed_deadlines = 0, contact_ticks = 0, lost_contact_ticks = 0;
  double seconds = 0;  ///< Wall time of the loop.
  std::uint64_t passivity_interventions = 0;
  double max_force_n = 0;  ///< Largest force written.
  Histogram wakeup_us;     ///< How late ticks began, of those that the loop slept for: the others are missed deadlines.
  Histogram tick_us;       ///< CPU time of the thread from reading the position to writing the force.
  bool fixed_priority = false, memory_locked = false;
  std::string realtime_note;  ///< Why one of them was refused; empty when both hold.
  bool device_lost = false;
  ForceGuard::Fault fault = ForceGuard::Fault::none;
};

/// Reads the device, computes, writes, `rate_hz` times a second, until the ticks are done, `stop` is set, the device is
/// lost or the guard reports a fault; then writes zero force and stops the device, on every way out.
///
/// A device that is a clock paces the loop by its own frames instead; `rate_hz` then only says how long a tick is.
/// Asks for SCHED_FIFO and locked memory and goes on without them. Ticks begin at absolute times, so that delays don't
/// add up; the loop sleeps until 5 % of a period, at most 50 µs, before them and spins for the rest. A tick that ends
/// after the next one should have begun is a missed deadline. With a simulated device the recording is the same bit for
/// bit on every run, whatever the timing.
/// @throws InvalidInput when the rate is not in [1, 100000] or a recording would need more than 20 million ticks.
LoopResult run_haptic_loop(HapticDevice& device, const ContactSurface& surface, const LoopOptions& options);

/// The recording as CSV: t,x,y,z (the hand, so that it can be replayed as a trajectory), probe, proxy, force, contact.
/// Numbers are written so that reading them gives the same bits.
std::string record_csv(std::span<const RecordRow> rows);

}  // namespace papilla
