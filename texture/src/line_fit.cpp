// SPDX-License-Identifier: MIT
#include "line_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace papilla::texture_detail {

double student_quantile(int degrees_of_freedom) {
  static constexpr std::array<double, 15> k_table = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                                                     2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131};
  if (degrees_of_freedom < 1) return 0;
  if (degrees_of_freedom <= static_cast<int>(k_table.size()))
    return k_table[static_cast<std::size_t>(degrees_of_freedom) - 1];
  // Cornish-Fisher expansion around the normal quantile, three digits from 16 degrees on.
  constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z;
  const double n = degrees_of_freedom;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n);
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

MeanInterval mean_interval(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  MeanInterval result;
  for (const double value : values) result.mean += value / count;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  const int freedom = static_cast<int>(values.size()) - 1;
  if (freedom > 0) result.half_width = student_quantile(freedom) * std::sqrt(squares / freedom / count);
  return result;
}

double jackknife_half_width(std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return student_quantile(static_cast<int>(values.size()) - 1) * std::sqrt(squares * (count - 1) / count);
}

void set_interval(FractalEstimate& estimate, double half_width) {
  estimate.low = estimate.dimension - half_width;
  estimate.high = estimate.dimension + half_width;
  if (!estimate.is_of_surface()) return;
  estimate.low = std::max(estimate.low, 2.0);
  estimate.high = std::min(estimate.high, 3.0);
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
  set_interval(estimate, fit.half_width);
  estimate.curve = std::move(curve);
  return estimate;
}

FractalEstimate mean_estimate(std::span<const FractalEstimate> pieces) {
  if (pieces.size() == 1) return pieces.front();
  std::vector<double> dimensions;
  std::map<double, std::pair<double, std::size_t>> logs;
  for (const FractalEstimate& piece : pieces) {
    dimensions.push_back(piece.dimension);
    for (const ScalePoint& point : piece.curve) {
      if (!(point.measure > 0)) continue;
      logs[point.scale].first += std::log(point.measure);
      ++logs[point.scale].second;
    }
  }
  const MeanInterval mean = mean_interval(dimensions);
  FractalEstimate result{mean.mean, 3 - mean.mean};
  set_interval(result, mean.half_width);
  for (const auto& [scale, sum] : logs)
    if (sum.second == pieces.size())
      result.curve.push_back({scale, std::exp(sum.first / static_cast<double>(pieces.size()))});
  return result;
}

}  // namespace papilla::texture_detail
