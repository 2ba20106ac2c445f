// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "bench/bench_json.hpp"

namespace papilla::bench {

/// Triangles that simplify() leaves within a tolerance, against libmeshoptimizer: its target error is searched for the
/// largest whose result holds the tolerance when both ways are measured.
class SimplifyComparison {
 public:
  /// Adds the subjects. The object must live until report() was called.
  explicit SimplifyComparison(BenchReport& report);
  ~SimplifyComparison();
  SimplifyComparison(const SimplifyComparison&) = delete;
  SimplifyComparison& operator=(const SimplifyComparison&) = delete;

  /// The target and its rows, after BenchReport::measure().
  void report(BenchReport& report) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace papilla::bench
