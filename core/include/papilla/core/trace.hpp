// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string_view>
#include <utility>
#include <vector>

namespace papilla {

/// One point of the error-over-run-time curve of an iterative or resolution-dependent method.
struct TraceSample {
  double seconds = 0;  ///< Wall time since the method was entered.
  double error = 0;    ///< The quantity that the method minimises; each method documents it and its unit.
};

using Trace = std::vector<TraceSample>;

/// Why an iteration ended. Only `converged` promises the tolerance that was asked for.
enum class StopReason { converged, direct, iteration_limit, time_limit, line_search_stalled };

/// The reason's name as reports print it, for example "iteration_limit".
std::string_view to_string(StopReason reason) noexcept;

/// The ending that promises less: direct, converged, line search stalled, iteration limit, time limit, in this order.
StopReason worse(StopReason a, StopReason b) noexcept;

/// Wall clock that starts when it is made.
class Stopwatch {
 public:
  double seconds() const noexcept {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// As seconds(), and starts again.
  double restart() noexcept {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace papilla
