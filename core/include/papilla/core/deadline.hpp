// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <limits>
#include <optional>

namespace papilla {

/// The time at which a computation should be done; never, unless seconds are given. A value: copies mean the same time.
class Deadline {
 public:
  Deadline() = default;
  /// So many seconds from now. Beyond a million: never.
  explicit Deadline(double seconds) {
    constexpr double k_never = 1e6;
    if (seconds < k_never) end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(seconds));
  }

  bool never() const noexcept { return !end_; }
  bool passed() const noexcept { return end_ && Clock::now() >= *end_; }

  /// Seconds from now, negative when it has passed; infinity for never.
  double left() const noexcept {
    return end_ ? Seconds(*end_ - Clock::now()).count() : std::numeric_limits<double>::infinity();
  }

  /// So many seconds before this one; never, if this one never comes.
  Deadline earlier_by(double seconds) const { return end_ ? Deadline(left() - seconds) : Deadline(); }

 private:
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  std::optional<Clock::time_point> end_;
};

}  // namespace papilla
