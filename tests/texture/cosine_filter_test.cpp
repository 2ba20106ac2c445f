// SPDX-License-Identifier: GPL-3.0-or-later
#include "cosine_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace papilla::texture_detail {
namespace {

struct Size {
  int width, height;
};

class CosineFilter : public testing::TestWithParam<Size> {};

double wave(int sample, int k, int count) { return std::cos(std::numbers::pi * (sample + 0.5) * k / count); }

/// The sum over all coefficients (u, v), each by its definition, times its gain.
std::vector<double> by_definition(const std::vector<double>& field, const std::vector<double>& gains, Size size) {
  const auto [width, height] = size;
  std::vector<double> result(field.size(), 0.0);
  const auto at = [width = width](int x, int y) { return static_cast<std::size_t>(y * width + x); };
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      double coefficient = 0;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) coefficient += field[at(x, y)] * wave(x, u, width) * wave(y, v, height);
      const double norm = (u == 0 ? 1.0 : 2.0) * (v == 0 ? 1.0 : 2.0) / (width * height);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          result[at(x, y)] += norm * gains[at(u, v)] * coefficient * wave(x, u, width) * wave(y, v, height);
    }
  return result;
}

TEST_P(CosineFilter, MultipliesEveryCoefficientByItsGain) {
  const auto [width, height] = GetParam();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<double> field(static_cast<std::size_t>(width * height)), gains(field.size()), result(field.size());
  for (double& v : field) v = value(random);
  for (double& v : gains) v = value(random);
  CosineFilter2d(width, height).apply(field, gains, result);
  const std::vector<double> expected = by_definition(field, gains, GetParam());
  for (std::size_t i = 0; i < field.size(); ++i) EXPECT_NEAR(result[i], expected[i], 1e-13) << i;
}

INSTANTIATE_TEST_SUITE_P(Sides, CosineFilter,
                         testing::Values(Size{1, 1}, Size{1, 6}, Size{5, 1}, Size{2, 2}, Size{8, 6}, Size{7, 9},
                                         Size{12, 5}, Size{15, 16}));

}  // namespace
}  // namespace papilla::texture_detail
