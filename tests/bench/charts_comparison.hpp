// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "bench/bench_json.hpp"

namespace papilla::bench {

/// Charts of segment_charts() against CGAL's segmentation and a split at edges of 45 degrees, at equal maximal
/// distortion: all are opened by the same rule, flattened by the same method, and halved where a chart has no valid
/// map; the peers' charts are halved further until none is more distorted than the worst of segment_charts(). On shapes
/// made by formula, and on the meshes given as files.
class ChartsComparison {
 public:
  /// Adds the subjects. The object must live until report() was called.
  explicit ChartsComparison(BenchReport& report);
  ~ChartsComparison();
  ChartsComparison(const ChartsComparison&) = delete;
  ChartsComparison& operator=(const ChartsComparison&) = delete;

  /// The target and its rows, after BenchReport::measure().
  void report(BenchReport& report) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace papilla::bench
