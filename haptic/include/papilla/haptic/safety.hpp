// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/vec.hpp"

namespace papilla {

struct SafetyLimits {
  double max_force_n = 3.3;
  double slew_n_per_s = 1650;   ///< Largest rate of change of the force.
  double steady_share = 0.04;   ///< Of that rate: the largest while a contact goes on.
  double new_contact_s = 2e-3;  ///< For so long a contact is new.
  double soft_start_s = 0.05;   ///< Duration of the fade-in from the first force on.
  double watchdog_s = 0.01;     ///< Largest age of a position; older ones stop all force.
};

/// Limits for a device: its largest force, reached from zero in 2 ms at the fastest; while a contact goes on, 2 % of it
/// a millisecond.
SafetyLimits safety_limits(double max_force_n) noexcept;

/// What the guard knows of the contact behind a force.
struct ContactStep {
  bool in_contact = false;
  double spring_n = 0;   ///< k·|n·Δx|, by which a spring along n changes with the hand's own way in this tick.
  double stiffness = 0;  ///< k [N/m].
  Vec3 moved_m;          ///< Δx.
};

/// The last stage before a device. For every input the output is finite, at most max_force_n long, and exactly zero
/// after a fault. In a tick of length T it changes by at most
///     slew·T                                  without a contact, or while it is younger than new_contact_s
///     max(steady_share·slew·T, spring_n)      while a contact goes on, at most slew·T
/// so that no relief, edge or stimulus makes a jolt, while a wall is as stiff as it was: to hold back the force of a
/// hand that goes in or out faster than steady_share·slew/k (165 mm/s for 400 N/m on a device of 3.3 N) would give it
/// energy.
///
/// Forces fade in from the first one, and from the first after a fault: without a contact their share rises from 0 to 1
/// in soft_start_s, and in a contact that share s(t) is the one of each change of their size,
///     |F| = integral of s(t) d|f|,
/// so that a wall that becomes stiffer while a hand is in it gives it no energy: F²/(2·s·k) is what it stores of the
/// work that was put in. What is held back so returns in soft_start_s and more while friction or damping pay for it:
/// |F| rises as far as F²/(2·s·k) is less than the work of the hand in this contact. Else the wall is felt deeper, by
/// what is held back over k, until the contact ends.
class ForceGuard {
 public:
  enum class Fault { none, not_finite, stale_input };

  explicit ForceGuard(const SafetyLimits& limits) noexcept : limits_(limits) {}

  /// @param age_s age of the position from which the force was computed.
  /// @returns the force to write; zero, without a ramp, from a fault until resume().
  Vec3 apply(Vec3 force_n, double period_s, double age_s, const ContactStep& contact = {}) noexcept;

  Fault fault() const noexcept { return fault_; }
  /// Clears a fault; forces fade in again.
  void resume() noexcept;

 private:
  Vec3 faded_in(Vec3 force_n, double period_s, const ContactStep& contact) noexcept;

  SafetyLimits limits_;
  Vec3 last_;
  double faded_in_s_ = 0, contact_s_ = 0;
  /// Of the contact that goes on: what the fade-in holds back, |f| of the last tick, work of the hand.
  double withheld_n_ = 0, raw_n_ = 0, work_j_ = 0;
  Fault fault_ = Fault::none;
};

}  // namespace papilla
