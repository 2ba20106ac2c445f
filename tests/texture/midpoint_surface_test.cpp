// SPDX-License-Identifier: MIT
#include "papilla/texture/midpoint_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr int k_runs = 4000;

/// E[(X(a) − X(b))²] over many seeds, coordinates in samples.
double mean_square(const MidpointOptions& options, int ax, int ay, int bx, int by) {
  double sum = 0;
  for (int run = 0; run < k_runs; ++run) {
    MidpointOptions seeded = options;
    seeded.seed = static_cast<std::uint64_t>(run) + 1;
    const HeightGrid surface = midpoint_surface(seeded);
    const double difference = surface.at(ax, ay) - surface.at(bx, by);
    sum += difference * difference;
  }
  return sum / k_runs;
}

class MidpointVariance : public testing::TestWithParam<double> {};

/// The mean of squares of normal numbers has the relative deviation √(2/n).
const double k_tolerance = 4 * std::sqrt(2.0 / k_runs);

TEST_P(MidpointVariance, FollowsTheVariogram) {
  const double h = GetParam();
  const MidpointOptions options{.levels = 1, .hurst = h};  // Corners, centre, edge middles: 3 × 3.
  const auto expect = [&](int ax, int ay, int bx, int by) {
    const double expected = std::pow(std::hypot(ax - bx, ay - by) / 2, 2 * h);
    EXPECT_NEAR(mean_square(options, ax, ay, bx, by) / expected, 1, k_tolerance);
  };
  expect(0, 0, 2, 0);  // Side.
  expect(0, 0, 2, 2);  // Diagonal: variance 2^H.
  expect(2, 0, 0, 2);
  expect(1, 1, 0, 0);  // The centre.
}

TEST_P(MidpointVariance, OfTheGraphIsExact) {
  const double h = GetParam();
  double half = 0, whole = 0, quarter = 0;
  for (int run = 0; run < k_runs; ++run) {
    const std::vector<double> graph =
        brownian_graph({.levels = 3, .hurst = h, .seed = static_cast<std::uint64_t>(run) + 1});
    ASSERT_EQ(graph.size(), 9U);
    EXPECT_EQ(graph[0], 0);
    whole += graph[8] * graph[8] / k_runs;
    half += std::pow(graph[4] - graph[0], 2) / k_runs;
    quarter += std::pow(graph[6] - graph[4], 2) / k_runs;
  }
  EXPECT_NEAR(whole, 1, k_tolerance);
  EXPECT_NEAR(half / std::pow(0.5, 2 * h), 1, k_tolerance);
  EXPECT_NEAR(quarter / std::pow(0.25, 2 * h), 1, k_tolerance);
}

INSTANTIATE_TEST_SUITE_P(Hurst, MidpointVariance, testing::Values(0.2, 0.5, 0.8));

TEST(MidpointSurface, PeriodicSurfacesHaveNoSeam) {
  for (const MidpointRule rule : {MidpointRule::corrected, MidpointRule::cho}) {
    const HeightGrid surface = midpoint_surface({.levels = 7, .hurst = 0.6, .periodic = true, .rule = rule, .seed = 3});
    EXPECT_EQ(surface.size, 128);
    EXPECT_TRUE(surface.periodic);
    double seam = 0, inside = 0;
    for (int i = 0; i < 128; ++i) {
      seam += std::abs(surface.at(127, i) - surface.at(0, i));
      inside += std::abs(surface.at(64, i) - surface.at(63, i));
    }
    EXPECT_LT(seam, 2 * inside);
  }
}

TEST(MidpointSurface, ChoDisplacesByPowersOfTwo) {
  // Level 1 on a tile: every corner is X; the centre is X ± 2^−H, its final value the mean of the edges ± 2^−H.
  const double h = 0.5, step = std::pow(2, -h);
  const HeightGrid surface = midpoint_surface({.levels = 1, .hurst = h, .periodic = true, .rule = MidpointRule::cho});
  ASSERT_EQ(surface.size, 2);
  const double edges = (surface.at(1, 0) + surface.at(0, 1)) / 2;
  EXPECT_NEAR(std::abs(surface.at(1, 1) - edges), step, 1e-12);
}

TEST(MidpointSurface, SameSeedSameSurface) {
  EXPECT_EQ(midpoint_surface({.seed = 9}).heights, midpoint_surface({.seed = 9}).heights);
  EXPECT_NE(midpoint_surface({.seed = 9}).heights, midpoint_surface({.seed = 10}).heights);
  EXPECT_EQ(midpoint_surface({}).size, 257);
}

TEST(MidpointSurface, RefusesBadOptions) {
  EXPECT_THROW(midpoint_surface({.levels = 0}), InvalidInput);
  EXPECT_THROW(midpoint_surface({.levels = 14}), InvalidInput);
  EXPECT_THROW(midpoint_surface({.hurst = 1}), InvalidInput);
  EXPECT_THROW(brownian_graph({.levels = 25}), InvalidInput);
  EXPECT_THROW(brownian_graph({.hurst = 0}), InvalidInput);
}

}  // namespace
}  // namespace papilla
