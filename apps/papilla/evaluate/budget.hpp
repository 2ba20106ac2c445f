// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>

#include "papilla/core/trace.hpp"

namespace papilla::app {

/// Wall time that an evaluation may take, from when it is made. Work that has begun is not cut short: what is honoured
/// is that nothing begins that is not expected to end in time.
class Budget {
 public:
  Budget() = default;
  explicit Budget(double seconds) : seconds_(seconds) {}

  double seconds() const { return seconds_; }
  double left() const { return std::max(0.0, seconds_ - clock_.seconds()); }
  bool spent() const { return left() <= 0; }
  bool allows(double expected_seconds) const { return expected_seconds <= left(); }

  /// A fair part of what is left for the next of `count` pieces of work.
  Budget share(std::size_t count) const {
    return Budget(left() / static_cast<double>(std::max<std::size_t>(count, 1)));
  }

 private:
  double seconds_ = std::numeric_limits<double>::infinity();
  Stopwatch clock_;
};

}  // namespace papilla::app
