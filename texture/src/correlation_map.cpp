// SPDX-License-Identifier: MIT
#include "correlation_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace papilla::texture_detail {
namespace {

/// Distortion that is left when the shift goes to zero, extrapolated from shifts of one and two pixels.
double noise_distortion(const FeatureMatrix& matrix) {
  if (matrix.reach_x < 2 || matrix.reach_y < 2) return 0;
  const double one = (matrix.at(1, 0) + matrix.at(0, 1)) / 2, two = (matrix.at(2, 0) + matrix.at(0, 2)) / 2;
  return std::clamp(2 * one - two, 0.0, one);
}

}  // namespace

CorrelationMap::CorrelationMap(const FeatureMatrix& matrix)
    : reach_x_(matrix.reach_x), reach_y_(matrix.reach_y), values_(matrix.distortion) {
  const double mean = std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(values_.size());
  if (!(mean > 0) || reach_x_ < 4 || reach_y_ < 4) return;
  usable_ = true;
  const double noise = noise_distortion(matrix);
  attainable_ = std::clamp(1 - noise / mean, 0.0, 1.0);
  values_[index(0, 0)] = noise;  // Pixel noise does not repeat: without this the origin stands out as a spike.
  for (double& value : values_) value = 1 - value / mean;
  smooth();
}

void CorrelationMap::smooth() {
  static constexpr std::array<double, 5> k_binomial = {1.0 / 16, 4.0 / 16, 6.0 / 16, 4.0 / 16, 1.0 / 16};
  const int width = 2 * reach_x_ + 1, height = 2 * reach_y_ + 1;
  const auto blur = [&](int count, int lines, std::size_t step, std::size_t line_step) {
    std::vector<double> line(static_cast<std::size_t>(count));
    for (int l = 0; l < lines; ++l) {
      double* values = values_.data() + static_cast<std::size_t>(l) * line_step;
      for (int i = 0; i < count; ++i) line[static_cast<std::size_t>(i)] = values[static_cast<std::size_t>(i) * step];
      for (int i = 0; i < count; ++i) {
        double sum = 0;
        for (int k = -2; k <= 2; ++k)
          sum += k_binomial[static_cast<std::size_t>(k + 2)] *
                 line[static_cast<std::size_t>(std::clamp(i + k, 0, count - 1))];
        values[static_cast<std::size_t>(i) * step] = sum;
      }
    }
  };
  blur(width, height, 1, static_cast<std::size_t>(width));
  blur(height, width, static_cast<std::size_t>(width), 1);
}

bool CorrelationMap::contains(Vec2 t) const { return std::abs(t.x) <= reach_x_ - 1 && std::abs(t.y) <= reach_y_ - 1; }

double CorrelationMap::sample(Vec2 t) const {
  const int x = static_cast<int>(std::floor(t.x)), y = static_cast<int>(std::floor(t.y));
  const double u = t.x - x, v = t.y - y;
  return (1 - v) * ((1 - u) * at(x, y) + u * at(x + 1, y)) + v * ((1 - u) * at(x, y + 1) + u * at(x + 1, y + 1));
}

bool CorrelationMap::is_peak(int dx, int dy) const {
  const double centre = at(dx, dy);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      if (x == 0 && y == 0) continue;
      const double other = at(dx + x, dy + y);
      const bool earlier = y < 0 || (y == 0 && x < 0);  // Of equal neighbours the first one is the peak.
      if (earlier ? other >= centre : other > centre) return false;
    }
  return true;
}

Vec2 CorrelationMap::refined_peak(int dx, int dy) const {
  double gx = 0, gy = 0, xx = 0, yy = 0;
  for (int k = -1; k <= 1; ++k) {  // Least squares over the 3 × 3 block.
    gx += (at(dx + 1, dy + k) - at(dx - 1, dy + k)) / 6;
    gy += (at(dx + k, dy + 1) - at(dx + k, dy - 1)) / 6;
    xx += (at(dx + 1, dy + k) - 2 * at(dx, dy + k) + at(dx - 1, dy + k)) / 3;
    yy += (at(dx + k, dy + 1) - 2 * at(dx + k, dy) + at(dx + k, dy - 1)) / 3;
  }
  const double xy = (at(dx + 1, dy + 1) - at(dx - 1, dy + 1) - at(dx + 1, dy - 1) + at(dx - 1, dy - 1)) / 4;
  const double determinant = xx * yy - xy * xy;
  Vec2 offset{};
  if (xx < 0 && determinant > 0) offset = {(xy * gy - yy * gx) / determinant, (xy * gx - xx * gy) / determinant};
  return {dx + std::clamp(offset.x, -1.0, 1.0), dy + std::clamp(offset.y, -1.0, 1.0)};
}

std::vector<Vec2> CorrelationMap::peaks() const {
  std::vector<Vec2> found;
  for (int dy = 0; dy < reach_y_; ++dy)
    for (int dx = dy == 0 ? 1 : 1 - reach_x_; dx < reach_x_; ++dx)
      if (dx * dx + dy * dy > 4 && is_peak(dx, dy)) found.push_back(refined_peak(dx, dy));
  return found;
}

Vec2 CorrelationMap::climb(Vec2 t) const {
  int x = static_cast<int>(std::lround(t.x)), y = static_cast<int>(std::lround(t.y));
  for (int step = 0; step <= 3; ++step) {
    if (std::abs(x) >= reach_x_ || std::abs(y) >= reach_y_) return t;
    int best_x = x, best_y = y;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (at(x + dx, y + dy) > at(best_x, best_y)) {
          best_x = x + dx;
          best_y = y + dy;
        }
    if (best_x == x && best_y == y) return refined_peak(x, y);
    x = best_x;
    y = best_y;
  }
  return t;
}

}  // namespace papilla::texture_detail
