// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "papilla/texture/fractal.hpp"
#include "papilla/texture/fshot_dimension.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/pipeline/pictures/plot.hpp"

namespace papilla {

/// One curve of the log-log plot.
struct LogLogSeries {
  std::string name;
  FractalEstimate estimate;
};

/// Every curve over its scales, both logarithmic and each divided by its first value, so that slopes can be compared.
Plot log_log_plot(const std::vector<LogLogSeries>& series);

/// Hurst exponent by direction as polar plot, with the fitted ellipse; angles as in the picture, clockwise from right.
Plot hurst_plot(const FshotSignature& signature);

/// Height over the middle row and the middle column, in millimetres.
Plot section_plot(const HeightMap& map);

}  // namespace papilla
