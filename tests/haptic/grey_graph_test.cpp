// SPDX-License-Identifier: MIT
#include "papilla/haptic/grey_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace papilla {
namespace {

std::vector<double> samples(const GreyGraph& graph) {
  std::vector<double> values;
  for (int i = 0; i < GreyGraph::k_samples; ++i) values.push_back(graph.at(i));
  return values;
}

/// Half the slope of log E[(g(i + k) − g(i))²] over log k, k from 1 to 16.
double hurst_of(const std::vector<double>& g) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0, n = 0;
  for (std::size_t k = 1; k <= 16; k *= 2) {
    double sum = 0;
    for (std::size_t i = 0; i + k < g.size(); ++i) sum += (g[i + k] - g[i]) * (g[i + k] - g[i]);
    const double x = std::log(static_cast<double>(k)), y = std::log(sum / static_cast<double>(g.size() - k));
    sx += x, sy += y, sxx += x * x, sxy += x * y, ++n;
  }
  return 0.5 * (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST(GreyGraph, FillsTheGreyLevels) {
  for (const double hurst : {0.0, 0.3, 0.5, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto g = samples(GreyGraph(hurst));
    EXPECT_NEAR(*std::min_element(g.begin(), g.end()), 0, 1e-12) << hurst;
    EXPECT_NEAR(*std::max_element(g.begin(), g.end()), 256, 1e-9) << hurst;
  }
}

TEST(GreyGraph, HasTheHurstExponent) {
  double before = 0;
  for (int i = 1; i <= 9; ++i) {
    const double hurst = 0.1 * i, found = hurst_of(samples(GreyGraph(hurst)));
    // One realisation of 257 samples: the deviation of this estimate is 0.04 to 0.08.
    EXPECT_NEAR(found, hurst, 0.12) << hurst;
    EXPECT_GT(found, before);
    before = found;
  }
}

/// For H = ½ the increments are the random numbers themselves; the covariance matrix of the source gives those of any
/// other H from them by its Cholesky factor.
TEST(GreyGraph, IsExactlyFractionalBrownianMotion) {
  constexpr std::size_t n = GreyGraph::k_samples - 1;
  const auto increments = [](double hurst) {
    const auto g = samples(GreyGraph(hurst));
    std::vector<double> d(n);
    for (std::size_t i = 0; i < n; ++i) d[i] = g[i + 1] - g[i];
    return d;
  };
  const std::vector<double> white = increments(0.5);
  for (const double hurst : {0.2, 0.8}) {
    const auto covariance = [hurst](double k) {
      return 0.5 * (std::pow(k + 1, 2 * hurst) + std::pow(std::abs(k - 1), 2 * hurst) - 2 * std::pow(k, 2 * hurst));
    };
    std::vector<double> factor(n * n, 0.0), expected(n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = covariance(static_cast<double>(i - j));
        for (std::size_t k = 0; k < j; ++k) sum -= factor[i * n + k] * factor[j * n + k];
        factor[i * n + j] = i == j ? std::sqrt(sum) : sum / factor[j * n + j];
        expected[i] += factor[i * n + j] * white[j];
      }
    const std::vector<double> found = increments(hurst);
    const double scale = found[0] / expected[0];
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(found[i], scale * expected[i], 1e-8 * 256) << hurst << ' ' << i;
  }
}

TEST(GreyGraph, LevelLeavesOutDetailAndKeepsTheForm) {
  const auto fine = samples(GreyGraph(0.5)), coarse = samples(GreyGraph(0.5, 4));
  for (std::size_t i = 0; i + 16 < coarse.size(); i += 16)
    for (std::size_t k = 1; k < 16; ++k)
      EXPECT_NEAR(coarse[i + k], coarse[i] + static_cast<double>(k) / 16 * (coarse[i + 16] - coarse[i]), 1e-9);
  // The places kept differ by shift and stretch alone.
  const double stretch = (coarse[256] - coarse[0]) / (fine[256] - fine[0]);
  for (std::size_t i = 0; i < coarse.size(); i += 16)
    EXPECT_NEAR(coarse[i] - coarse[0], stretch * (fine[i] - fine[0]), 1e-9);
}

TEST(GreyGraph, IsMirroredAtItsEndsAndContinuous) {
  const GreyGraph graph(0.3);
  EXPECT_EQ(graph.at(256 + 10), graph.at(256 - 10));
  EXPECT_EQ(graph.at(512 + 3.25), graph.at(3.25));
  EXPECT_EQ(graph.at(-7.5), graph.at(7.5));
  EXPECT_NEAR(graph.at(255.999999), graph.at(256.000001), 1e-3);
}

}  // namespace
}  // namespace papilla
