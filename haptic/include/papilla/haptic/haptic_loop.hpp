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
#include "papilla/haptic/loop_clock.hpp"
#include "papilla/haptic/real_part.hpp"
#include "papilla/haptic/safety.hpp"
#include "papilla/haptic/trajectory.hpp"

namespace papilla {

/// One tick of a recording.
struct RecordRow {
  double t = 0;  ///< s
  Vec3 hand, probe, proxy, force;
  bool in_contact = false;
};

/// State of a running loop for other threads. The values may be one tick apart.
struct LoopStatus {
  std::atomic<std::uint64_t> ticks{0}, contact_ticks{0}, lost_contact_ticks{0}, missed_deadlines{0};
  std::atomic<double> force_n{0}, tick_us{0}, wakeup_us{0};
};

struct LoopOptions {
  double rate_hz = 1000;
  std::uint64_t ticks = 2000;
  bool control_passivity = false;            ///< See PassivityController.
  const RealPart* real_part = nullptr;       ///< The hand moves on it; nullptr: in the scene.
  double watchdog_s = 0.01;                  ///< Largest age of a position, older ones stop all force; longest pause.
  bool paced = true;                         ///< False: no waiting between ticks (tests, fast replays).
  LoopClock* clock = nullptr;                ///< Paces the loop; nullptr: the system's.
  const Trajectory* hand = nullptr;          ///< Hand columns of the recording; without it those of the probe.
  std::vector<RecordRow>* record = nullptr;  ///< One row per tick, allocated before the loop.
  std::span<RecordRow> recent = {};          ///< Tick i goes to place i % size, for who follows `status`.
  LoopStatus* status = nullptr;              ///< Updated every tick, lock-free.
  LatestSlot<RecordRow>* latest = nullptr;   ///< Receives every tick.
  const std::atomic<bool>* stop = nullptr;   ///< The loop ends at the next tick when it is true.
};

struct LoopResult {
  std::uint64_t ticks = 0, contact_ticks = 0, lost_contact_ticks = 0;
  std::uint64_t missed_deadlines = 0;  ///< Ticks that began late, and those that fell out in a pause.
  std::uint64_t pauses = 0;            ///< How often the loop stood still for longer than the watchdog.
  double longest_pause_s = 0;          ///< Beyond the period.
  double seconds = 0;                  ///< Wall time of the loop.
  std::uint64_t passivity_interventions = 0;
  double max_force_n = 0;  ///< Largest force written.
  Histogram wakeup_us;     ///< Lateness of the ticks that the loop slept for; the others are missed deadlines.
  Histogram tick_us;       ///< CPU time of the thread from reading the position to writing the force.
  bool fixed_priority = false, memory_locked = false;
  std::string
      realtime_note;  ///< Why one of them was refused; empty when both are true, and when the loop is not paced.
  bool device_lost = false;
  ForceGuard::Fault fault = ForceGuard::Fault::none;
};

/// Reads the device, computes, writes, `rate_hz` times a second, until the ticks are done, `stop` is set, the device is
/// lost or the guard reports a fault; then writes zero force and stops the device, on every way out.
///
/// A device that is a clock paces the loop by its frames; `rate_hz` is then only the length of a tick. A loop that is
/// paced requests SCHED_FIFO and locked memory and runs without them when refused. Ticks begin at absolute times, so
/// delays don't accumulate; the loop sleeps until 5 % of a period, at most 50 µs, before a tick and spins for the rest.
/// A tick that ends after the start of the next one is a missed deadline.
///
/// A tick that begins more than a period and `watchdog_s` after the last one follows a pause: the process or the
/// machine was stopped, suspended, or had no processor. The hand went on meanwhile, so the proxy is put to the newest
/// position, free, forces fade in again from zero, and the ticks that fell out count as missed. A force that such a
/// pause made old between read() and write() is not written.
///
/// With a simulated device the recording is the same on every run, bit for bit, whatever the timing, as long as there
/// is no pause.
/// @throws InvalidInput when the rate is not in [1, 100000] or a recording would need more than 20 million ticks.
LoopResult run_haptic_loop(HapticDevice& device, const ContactSurface& surface, const LoopOptions& options);

/// The recording as CSV: t,x,y,z (the hand, so that it can be replayed as a trajectory), probe, proxy, force, contact.
/// Numbers are the shortest that parse to the same bits.
std::string record_csv(std::span<const RecordRow> rows);

}  // namespace papilla
