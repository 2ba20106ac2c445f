// SPDX-License-Identifier: MIT
#include "papilla/texture/slope_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "papilla/core/error.hpp"
#include "papilla/texture/grain.hpp"

namespace papilla {
namespace {

constexpr double k_pitch_mm = 0.05;

template <class Height>
HeightMap relief_of(int width, int height, bool periodic, const Height& z) {
  HeightMap map{width, height, {}, k_pitch_mm, k_pitch_mm, periodic};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) map.mm.push_back(static_cast<float>(z(x, y)));
  return map;
}

double mean(const HeightMap& map) {
  return std::accumulate(map.mm.begin(), map.mm.end(), 0.0) / static_cast<double>(map.mm.size());
}

double height_mm(const HeightMap& map, int x, int y) { return static_cast<double>(map.at(x, y)); }

double steepest(const HeightMap& map) {
  double most = 0;
  for (int y = 0; y + 1 < map.height; ++y)
    for (int x = 0; x + 1 < map.width; ++x) {
      const double here = height_mm(map, x, y);
      most = std::max(most, std::hypot(height_mm(map, x + 1, y) - here, height_mm(map, x, y + 1) - here) / k_pitch_mm);
    }
  return most;
}

/// A wall of 0.4 mm becomes a ramp of 0.4 mm width around the same place; elsewhere nothing changes.
TEST(SlopeLimit, AWallBecomesARampAroundItsPlace) {
  const HeightMap wall = relief_of(64, 8, false, [](int x, int) { return x < 32 ? 0.0 : 0.4; });
  const SlopeLimitResult result = limit_slope(wall, {.max_slope = 1});
  EXPECT_EQ(result.stop, StopReason::converged);
  EXPECT_NEAR(result.steepest_before, 0.4 / k_pitch_mm, 1e-5);
  EXPECT_LE(result.steepest_after, 1 + 1e-6);
  EXPECT_GT(result.steepest_after, 0.99);
  EXPECT_NEAR(result.share_before, 1.0 / 64, 1e-12);
  EXPECT_EQ(result.share_after, 0);
  for (int x = 0; x < 64; ++x) {
    const double expected = std::clamp(0.2 + (x - 31.5) * k_pitch_mm, 0.0, 0.4);
    EXPECT_NEAR(result.relief.at(x, 3), expected, 0.01) << x;
    if (std::abs(x - 31.5) > 8) {
      EXPECT_EQ(result.relief.at(x, 3), wall.at(x, 3)) << x;
    }
  }
  EXPECT_NEAR(mean(result.relief), mean(wall), 1e-7);
}

TEST(SlopeLimit, GentleReliefStaysBitForBit) {
  const HeightMap wave = relief_of(64, 64, true, [](int x, int y) { return 0.05 * std::sin(0.0981747704 * (x + y)); });
  const SlopeLimitResult result = limit_slope(wave, {.max_slope = 0.5});
  EXPECT_EQ(result.stop, StopReason::direct);
  EXPECT_EQ(result.relief.mm, wave.mm);
  EXPECT_EQ(result.share_before, 0);
  EXPECT_TRUE(result.trace.empty());
}

/// Two steep places far apart: the volume of each half stays, and the two do not know of each other.
TEST(SlopeLimit, VolumeStaysWhereItWas) {
  const auto peak = [](int x, int y, int at) { return std::hypot(x - at, y - 32) < 6 ? 0.5 : 0.0; };
  const HeightMap both = relief_of(128, 64, true, [&](int x, int y) { return peak(x, y, 32) + peak(x, y, 96); });
  const HeightMap one = relief_of(128, 64, true, [&](int x, int y) { return peak(x, y, 32); });
  const SlopeLimitResult of_both = limit_slope(both, {.max_slope = 1}), of_one = limit_slope(one, {.max_slope = 1});
  const auto half = [](const HeightMap& map) {
    double sum = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) sum += height_mm(map, x, y);
    return sum;
  };
  EXPECT_NEAR(half(of_both.relief), half(both), 1e-5);
  EXPECT_NEAR(half(of_one.relief), half(one), 1e-5);
  for (int x = 0; x < 64; ++x) EXPECT_NEAR(of_both.relief.at(x, 32), of_one.relief.at(x, 32), 2e-3) << x;
}

/// Of all reliefs that are gentle enough it is the nearest: moving towards another one takes it away.
TEST(SlopeLimit, IsTheNearestGentleRelief) {
  const GrainResult grain = synthesize_grain(GrainKind::leather, {.size_px = 64, .size_mm = 3.2});
  for (const double limit : {0.3, 0.8}) {
    const SlopeLimitResult result = limit_slope(grain.relief, {.max_slope = limit, .relative_tolerance = 1e-4});
    ASSERT_EQ(result.stop, StopReason::converged);
    EXPECT_LE(steepest(result.relief), limit * (1 + 1e-5));
    EXPECT_NEAR(mean(result.relief), mean(grain.relief), 1e-7);
    double largest = 0;
    for (const int shift : {0, 1, 7, 20}) {
      // Feasible: a shifted copy, and the mean.
      double along = 0, length = 0;
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
          const double here = height_mm(result.relief, x, y);
          const double way = 0.9 * height_mm(result.relief, (x + shift) % 64, y) - here;
          along += way * (height_mm(grain.relief, x, y) - here);
          length += way * way;
        }
      largest = std::max(largest, along / std::sqrt(length));
    }
    EXPECT_LT(largest, 0.02 * result.rms_change_mm * 64);
  }
}

TEST(SlopeLimit, BordersAreOpenOrAroundTheSeam) {
  const HeightMap open = relief_of(32, 32, false, [](int x, int) { return 0.02 * x; });
  EXPECT_EQ(limit_slope(open, {.max_slope = 1}).stop, StopReason::direct);
  HeightMap closed = open;
  closed.periodic = true;
  const SlopeLimitResult result = limit_slope(closed, {.max_slope = 1});
  EXPECT_EQ(result.stop, StopReason::converged);
  for (int y = 0; y < 32; ++y)
    EXPECT_LE(std::abs(result.relief.at(0, y) - result.relief.at(31, y)), k_pitch_mm * (1 + 1e-5));
}

/// A wall between rows that lie twice as far apart as columns, with one at the border of the tile.
TEST(SlopeLimit, RowsHaveTheirOwnPitchAndTheirOwnSeam) {
  HeightMap wall = relief_of(8, 64, true, [](int, int y) { return y < 32 ? 0.0 : 0.4; });
  wall.pitch_mm_y = 2 * k_pitch_mm;
  const SlopeLimitResult result = limit_slope(wall, {.max_slope = 1});
  EXPECT_NEAR(result.steepest_before, 0.4 / (2 * k_pitch_mm), 1e-5);
  EXPECT_NEAR(result.share_before, 2.0 / 64, 1e-12);
  for (int y = 0; y < 64; ++y) {
    const double step = std::abs(height_mm(result.relief, 3, (y + 1) % 64) - height_mm(result.relief, 3, y));
    EXPECT_LE(step, 2 * k_pitch_mm * (1 + 1e-5)) << y;
    const double expected = std::clamp(0.2 + (y - 31.5) * 2 * k_pitch_mm, 0.0, 0.4);
    if (y > 8 && y < 56) {
      EXPECT_NEAR(result.relief.at(3, y), expected, 0.01) << y;
    }
  }
}

TEST(SlopeLimit, TraceFallsToTheLimit) {
  const GrainResult grain = synthesize_grain(GrainKind::quads8, {.size_px = 128, .size_mm = 10, .height_mm = 0.6});
  const SlopeLimitResult result = limit_slope(grain.relief, {.max_slope = 0.6});
  ASSERT_EQ(result.stop, StopReason::converged);
  EXPECT_EQ(static_cast<int>(result.trace.size()), result.iterations + 1);
  EXPECT_NEAR(result.trace.front().error, result.steepest_before / 0.6 - 1, 1e-9);
  EXPECT_LE(result.trace.back().error, 0);
  const SlopeLimitResult stopped = limit_slope(grain.relief, {.max_slope = 0.6, .iterations = 3});
  EXPECT_EQ(stopped.stop, StopReason::iteration_limit);
  EXPECT_GT(stopped.share_after, 0);
}

TEST(SlopeLimit, RefusesWhatItCannotUse) {
  const HeightMap flat = relief_of(4, 4, true, [](int, int) { return 0.0; });
  EXPECT_THROW(limit_slope(flat, {.max_slope = 0}), InvalidInput);
  EXPECT_THROW(limit_slope(flat, {.max_slope = std::nan("")}), InvalidInput);
  EXPECT_THROW(limit_slope(flat, {.relative_tolerance = 0}), InvalidInput);
  HeightMap odd = flat;
  odd.mm[3] = std::nanf("");
  EXPECT_THROW(limit_slope(odd, {}), InvalidInput);
  odd = flat;
  odd.pitch_mm_x = 0;
  EXPECT_THROW(limit_slope(odd, {}), InvalidInput);
}

}  // namespace
}  // namespace papilla
