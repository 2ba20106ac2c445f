// SPDX-License-Identifier: MIT
#include "line_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace papilla::texture_detail {

double student_quantile(int degrees_of_freedom) {
  static constexpr std::array<double, 15> k_table = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                                                     2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131};
  if (degrees_of_freedom < 1) return 0;
  if (degrees_of_freedom <= static_cast<int>(k_table.size()))
    return k_table[static_cast<std::size_t>(degrees_of_freedom) - 1];
  // Cornish-Fisher expansion around the normal quantile, three digits from 16 degrees on.
  constexpr double z = 1.959964;
  return z + (z * z * z + z) / (4 * degrees_of_freedom);
}

LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& weights) {
  const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
  double sum = 0, mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += weight(i);
    mean_x += weight(i) * x[i];
    mean_y += weight(i) * y[i];
  }
  mean_x /= sum;
  mean_y /= sum;
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += weight(i) * (x[i] - mean_x) * (x[i] - mean_x);
    xy += weight(i) * (x[i] - mean_x) * (y[i] - mean_y);
  }
  LineFit fit;
  fit.slope = xy / xx;
  fit.intercept = mean_y - fit.slope * mean_x;
  const int freedom = static_cast<int>(x.size()) - 2;
  if (freedom > 0) {
    double residual = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double error = y[i] - fit.intercept - fit.slope * x[i];
      residual += weight(i) * error * error;
    }
    fit.half_width = student_quantile(freedom) * std::sqrt(residual / freedom / xx);
  }
  return fit;
}

FractalEstimate estimate_from_log_log(std::vector<ScalePoint> curve) {
  std::vector<double> x, y;
  for (const ScalePoint& point : curve) {
    x.push_back(std::log(point.scale));
    y.push_back(std::log(point.measure));
  }
  const LineFit fit = fit_line(x, y);
  FractalEstimate estimate;
  estimate.dimension = -fit.slope;
  estimate.hurst = 3 - estimate.dimension;
  estimate.low = estimate.dimension - fit.half_width;
  estimate.high = estimate.dimension + fit.half_width;
  estimate.curve = std::move(curve);
  return estimate;
}

}  // namespace papilla::texture_detail
