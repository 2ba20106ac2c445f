// SPDX-License-Identifier: MIT
#include "even_contrast.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "checks.hpp"
#include "shaped_noise.hpp"

namespace papilla::texture_detail {
namespace {

using Quadric = Eigen::Matrix<double, 6, 1>;

Quadric terms(double u, double v) {
  Quadric t;
  t << 1, u, v, u * u, u * v, v * v;
  return t;
}

/// Coordinates in [−1, 1] of the pixels of a row or column.
double centred(int i, int count) { return count > 1 ? 2.0 * i / (count - 1) - 1 : 0; }

/// The values of the quadric that fits best, at every sample.
std::vector<double> best_quadric(const std::vector<double>& field, int width, int height) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Quadric right = Quadric::Zero();
  for (int y = 0; y < height; ++y) {
    const double v = centred(y, height);
    // Sums of 1, u … u⁴ and of field · 1, u, u² along the row give all its products.
    std::array<double, 5> powers{};
    std::array<double, 3> moments{};
    for (int x = 0; x < width; ++x) {
      const double u = centred(x, width), value = field[pixel_index(x, y, width)];
      const double uu = u * u;
      powers[0] += 1;
      powers[1] += u;
      powers[2] += uu;
      powers[3] += uu * u;
      powers[4] += uu * uu;
      moments[0] += value;
      moments[1] += u * value;
      moments[2] += uu * value;
    }
    static constexpr std::array<std::array<int, 2>, 6> k_powers = {{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
    for (int i = 0; i < 6; ++i) {
      const auto& [p, q] = k_powers[static_cast<std::size_t>(i)];
      right(i) += moments[static_cast<std::size_t>(p)] * std::pow(v, q);
      for (int j = 0; j < 6; ++j) {
        const auto& [r, s] = k_powers[static_cast<std::size_t>(j)];
        normal(i, j) += powers[static_cast<std::size_t>(p + r)] * std::pow(v, q + s);
      }
    }
  }
  const Quadric best = normal.completeOrthogonalDecomposition().solve(right);
  std::vector<double> values(field.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      values[pixel_index(x, y, width)] = best.dot(terms(centred(x, width), centred(y, height)));
  return values;
}

double mean_of(const std::vector<double>& field) {
  double sum = 0;
  for (const double value : field) sum += value;
  return sum / static_cast<double>(field.size());
}

}  // namespace

GreyImage with_even_light(const GreyImage& image) {
  constexpr double k_least_gain = 1.0 / 16;  // Of the mean square.
  std::vector<double> field(image.pixels.begin(), image.pixels.end());
  const double mean = mean_of(field);
  const std::vector<double> low = best_quadric(field, image.width, image.height);
  std::vector<double> squares(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) {
    field[i] -= low[i];
    squares[i] = field[i] * field[i];
  }
  const double square = mean_of(squares);
  GreyImage even = image;
  if (!(square > 0)) return even;
  even.bits = 32;
  const std::vector<double> spread = best_quadric(squares, image.width, image.height);
  for (std::size_t i = 0; i < field.size(); ++i)
    even.pixels[i] = static_cast<float>(mean + field[i] / std::sqrt(std::max(k_least_gain, spread[i] / square)));
  return even;
}

std::vector<double> locally_normalized(const GreyImage& image, double deviation_px) {
  constexpr double k_least_share = 0.2;
  const auto low = [&](std::vector<double>& field) {
    filter(field, image.width, image.height, false, [=](double fx, double fy) {
      return std::exp(-2 * std::numbers::pi * std::numbers::pi * deviation_px * deviation_px * (fx * fx + fy * fy));
    });
  };
  std::vector<double> field(image.pixels.begin(), image.pixels.end()), mean = field, squares(field.size());
  low(mean);
  for (std::size_t i = 0; i < field.size(); ++i) {
    field[i] -= mean[i];
    squares[i] = field[i] * field[i];
  }
  const double square = mean_of(squares);
  if (!(square > 0)) return std::vector<double>(field.size(), 0.0);
  low(squares);
  for (std::size_t i = 0; i < field.size(); ++i)
    field[i] /= std::sqrt(std::max(k_least_share * k_least_share * square, squares[i]));
  return field;
}

}  // namespace papilla::texture_detail
