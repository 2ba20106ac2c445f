// SPDX-License-Identifier: MIT
#pragma once

namespace papilla {

/// The clock of a loop: the system's time since the start, which nobody can set and which goes on while the machine is
/// suspended (CLOCK_BOOTTIME). Tests replace it.
class LoopClock {
 public:
  LoopClock() = default;
  LoopClock(const LoopClock&) = delete;
  LoopClock& operator=(const LoopClock&) = delete;
  virtual ~LoopClock() = default;

  virtual double now_s() noexcept;
  /// Sleeps until now_s() is `time_s`, and a little longer.
  virtual void sleep_until(double time_s) noexcept;
};

}  // namespace papilla
