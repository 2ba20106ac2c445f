// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/texture/fractal.hpp"
#include "papilla/texture/fshot_dimension.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla::app {

/// One curve of the log-log plot.
struct LogLogSeries {
  std::string name;
  FractalEstimate estimate;
};

/// SVG: every curve over its scales, both logarithmic and each shifted to begin at 1, so that slopes can be compared.
std::string log_log_chart(const std::vector<LogLogSeries>& series);

/// SVG: Hurst exponent by direction as polar plot, with the fitted ellipse.
std::string hurst_chart(const FshotSignature& signature);

/// SVG: height over the middle row and the middle column, in millimetres.
std::string section_chart(const HeightMap& map);

}  // namespace papilla::app
