// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "seam_state.hpp"

namespace papilla::param_detail {

/// The maps that a search for seams has made so far, of one mesh or of several.
class SeamTrace {
 public:
  /// @param since when its seconds count. @param usual_triangles of all maps that a search usually makes.
  SeamTrace(const Stopwatch& since, double usual_triangles, const ProgressCallback& progress)
      : usual_triangles_(usual_triangles), progress_(progress), clock_(since) {}

  /// @throws Cancelled as report_progress().
  void add(const SeamMesh& mesh, const SeamState& state) {
    samples_.push_back({clock_.seconds(), mesh.rest.size(), state.seam_mm, state.cost_mm, state.distortion});
    triangles_ += static_cast<double>(mesh.rest.size());
    report_progress(progress_, "seams", 1 - std::exp(-triangles_ / usual_triangles_));
  }

  std::vector<SeamSample> take() { return std::move(samples_); }

 private:
  double usual_triangles_, triangles_ = 0;
  const ProgressCallback& progress_;
  Stopwatch clock_;
  std::vector<SeamSample> samples_;
};

}  // namespace papilla::param_detail
