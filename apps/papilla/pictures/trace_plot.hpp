// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/core/trace.hpp"

namespace papilla::app {

struct TraceCurve {
  std::string name;
  Trace trace;
  bool in_front = false;  ///< Set by mark_front().
};

/// Marks the curves of which a sample is on the Pareto front: no other sample is both faster and has less error.
void mark_front(std::vector<TraceCurve>& curves);

/// Error over run time as SVG, both axes logarithmic: a curve with dots per method, the Pareto front as a grey
/// staircase below them, a legend at the right with the methods on the front in bold. Errors of 0 and less are drawn at
/// the lower edge.
std::string trace_plot_svg(const std::string& title, const std::string& error_name,
                           const std::vector<TraceCurve>& curves);

}  // namespace papilla::app
