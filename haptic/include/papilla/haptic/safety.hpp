// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/vec.hpp"

namespace papilla {

struct SafetyLimits {
  double max_force_n = 3.3;
  double slew_n_per_s = 1650;  ///< Largest rate of change of the force.
  double soft_start_s = 0.05;  ///< Duration of the fade-in of the first force.
  double watchdog_s = 0.01;    ///< Largest age of a position; older ones stop all force.
};

/// Limits for a device: its largest force, reached from zero in 2 ms at the fastest.
SafetyLimits safety_limits(double max_force_n) noexcept;

/// The last stage before a device. For every input the output is finite, at most max_force_n long, changes by at most
/// slew_n_per_s, and is exactly zero after a fault.
class ForceGuard {
 public:
  enum class Fault { none, not_finite, stale_input };

  explicit ForceGuard(const SafetyLimits& limits) noexcept : limits_(limits) {}

  /// @param age_s age of the position from which the force was computed.
  /// @returns the force to write; zero, without a ramp, from a fault until resume().
  Vec3 apply(Vec3 force_n, double period_s, double age_s) noexcept;

  Fault fault() const noexcept { return fault_; }
  /// Clears a fault; forces fade in again.
  void resume() noexcept;

 private:
  SafetyLimits limits_;
  Vec3 last_;
  double faded_in_s_ = 0;
  Fault fault_ = Fault::none;
};

}  // namespace papilla
