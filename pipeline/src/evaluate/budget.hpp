// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "papilla/core/trace.hpp"

namespace papilla {

/// Wall time that an evaluation may take, counted from construction. Work that has begun is not interrupted; no work is
/// begun that is not expected to end in time.
class Budget {
 public:
  Budget() = default;
  explicit Budget(double seconds) : seconds_(seconds) {}

  double seconds() const { return seconds_; }
  double left() const { return std::max(0.0, seconds_ - clock_.seconds()); }
  bool spent() const { return left() <= 0; }
  bool allows(double expected_seconds) const { return expected_seconds <= left(); }

  /// An equal part of the time left, for the next of `count` pieces of work.
  Budget share(std::size_t count) const {
    return Budget(left() / static_cast<double>(std::max<std::size_t>(count, 1)));
  }

 private:
  double seconds_ = std::numeric_limits<double>::infinity();
  Stopwatch clock_;
};

/// Work in steps of growing cost.
class Ladder {
 public:
  /// @param growth expected time of a rung over that of the one before.
  Ladder(const Budget& budget, double growth) : budget_(budget), growth_(growth) {}

  /// Whether the next rung may begin: the first one while time is left, a further one when it is expected to end in
  /// time.
  bool next() {
    const bool allowed = !budget_.spent() && budget_.allows(begun_ ? growth_ * clock_.seconds() : 0);
    begun_ = true;
    clock_ = Stopwatch();
    return allowed;
  }

 private:
  const Budget& budget_;
  double growth_;
  bool begun_ = false;
  Stopwatch clock_;
};

/// EvaluationRun::stop of a method that had no time.
inline constexpr const char* k_time_spent = "not run: the time was spent";

}  // namespace papilla
