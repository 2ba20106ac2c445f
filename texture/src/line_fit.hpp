// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/texture/fractal.hpp"

namespace papilla::texture_detail {

/// The line through (x_i, y_i) by weighted least squares.
struct LineFit {
  double slope = 0, intercept = 0;
  double half_width = 0;  ///< Half of the 95 % interval of the slope (Student), 0 for two points.
};

/// Weights may be empty (all 1). @pre at least two different x.
LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& weights = {});

/// The 97.5 % quantile of Student's distribution with that many degrees of freedom.
double student_quantile(int degrees_of_freedom);

/// Mean of independent values and half of its 95 % interval (Student), 0 for a single value.
struct MeanInterval {
  double mean = 0, half_width = 0;
};
MeanInterval mean_interval(const std::vector<double>& values);

/// Half of the 95 % interval (Student) of a statistic whose values without one of n blocks each are given.
double jackknife_half_width(std::span<const double> values);

/// The estimate's interval: dimension ± half width, cut to [2, 3] where the dimension is within.
void set_interval(FractalEstimate& estimate, double half_width);

/// Dimension from a curve whose log measure falls with −D in log scale: the regression's slope and interval.
FractalEstimate estimate_from_log_log(std::vector<ScalePoint> curve);

/// Mean of the estimates from the pieces of a picture, with the interval of that mean; the curve is the geometric mean
/// at the scales all of them have. One piece gives itself. @pre at least one piece.
FractalEstimate mean_estimate(std::span<const FractalEstimate> pieces);

}  // namespace papilla::texture_detail
