// SPDX-License-Identifier: MIT
#include "papilla/haptic/roughness_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

TEST(RoughnessField, HasTheHeightAskedForAndRepeats) {
  const RoughnessTag tag{2.3, 2e-5, {2e-4, 1e-2}};
  const HeightField field = roughness_field(tag, {0.04, 0.04}, 7);
  double sum = 0, sum2 = 0;
  int n = 0;
  for (double u = 0; u < 0.25; u += 1.0 / 1024)
    for (double v = 0; v < 0.25; v += 1.0 / 1024, ++n) {
      const double h = field.sample({u, v}).height_m;
      sum += h;
      sum2 += h * h;
    }
  EXPECT_NEAR(sum / n, 0, 1e-7);
  EXPECT_NEAR(std::sqrt(sum2 / n), 2e-5, 2e-7);
  EXPECT_NEAR(field.sample({0.1, 0.1}).height_m, field.sample({0.35, 0.1}).height_m, 1e-12);
  EXPECT_EQ(roughness_field(tag, {0.04, 0.04}, 7).sample({0.11, 0.2}).height_m, field.sample({0.11, 0.2}).height_m);
}

TEST(RoughnessField, RepeatsAfterItsLongestWaveAlongBothAxes) {
  // 10 mm are a quarter of a unit of u and a third of one of v.
  const HeightField field = roughness_field({2.3, 2e-5, {2e-4, 1e-2}}, {0.04, 0.03}, 7);
  for (const double u : {0.03, 0.2})
    for (const double v : {0.05, 0.31}) {
      const double height = field.sample({u, v}).height_m;
      EXPECT_NEAR(field.sample({u + 0.25, v}).height_m, height, 1e-12);
      EXPECT_NEAR(field.sample({u, v + 1.0 / 3}).height_m, height, 1e-12);
      EXPECT_GT(std::abs(field.sample({u, v + 0.25}).height_m - height), 1e-7);
    }
}

/// An oblong relief of 96 × 60 texels of 0.5 × 0.4 mm: a wave along its rows.
HeightField oblong() {
  std::vector<std::uint16_t> samples;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 96; ++x)
      samples.push_back(static_cast<std::uint16_t>(30000 + 8000 * std::sin(2 * M_PI * x / 96)));
  HeightFieldOptions options;
  options.scale_m = 1e-3;
  options.offset_m = -2e-4;
  return HeightField(96, 60, std::move(samples), options);
}
constexpr Vec2 k_oblong_m{0.048, 0.024};

/// Mean square of the difference over `by` of the two fields' difference.
double structure(const HeightField& rough, const HeightField& plain, Vec2 by) {
  double sum = 0;
  int n = 0;
  for (double u = 0.003; u < 1; u += 0.0101)
    for (double v = 0.007; v < 1; v += 0.0119, ++n) {
      const auto added = [&](Vec2 at) { return rough.sample(at).height_m - plain.sample(at).height_m; };
      const double step = added({u + by.x / k_oblong_m.x, v + by.y / k_oblong_m.y}) - added({u, v});
      sum += step * step;
    }
  return sum / n;
}

TEST(WithRoughness, AddsItsRmsAndLeavesTheReliefBelow) {
  const HeightField plain = oblong();
  const RoughnessTag tag{2.5, 2e-5, {6e-4, 5e-3}, 1, 0, true};
  const HeightField rough = with_roughness(plain, tag, k_oblong_m, 3);
  EXPECT_EQ(rough.width(), 4 * 96);  // 0.5 mm are cut to a quarter of 0.6 mm and less.
  EXPECT_EQ(rough.height(), 4 * 60);
  double sum = 0, squares = 0;
  int n = 0;
  for (double u = 0.5 / 384; u < 1; u += 1.0 / 384)
    for (double v = 0.5 / 240; v < 1; v += 1.0 / 240, ++n) {
      const double added = rough.sample({u, v}).height_m - plain.sample({u, v}).height_m;
      sum += added;
      squares += added * added;
    }
  EXPECT_NEAR(sum / n, 0, 2e-7);
  EXPECT_NEAR(std::sqrt(squares / n), 2e-5, 1e-6);
  EXPECT_NEAR(rough.sample({0.31, 0.7}).height_m, rough.sample({1.31, -0.3}).height_m, 1e-12);
}

/// Between the two wavelengths the mean square of differences grows as r^2H; its logarithmic slope is the known answer.
TEST(WithRoughness, DifferencesGrowAsTheDimensionSays) {
  const HeightField plain = oblong();
  for (const double hurst : {0.3, 0.7}) {
    double slope = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const RoughnessTag tag{3 - hurst, 2e-5, {3e-4, 2.4e-2}, 1, 0, true};
      const HeightField rough = with_roughness(plain, tag, k_oblong_m, seed);
      slope += std::log(structure(rough, plain, {2.4e-3, 0}) / structure(rough, plain, {6e-4, 0})) / std::log(4.0) / 8;
      slope += std::log(structure(rough, plain, {0, 2.4e-3}) / structure(rough, plain, {0, 6e-4})) / std::log(4.0) / 8;
    }
    EXPECT_NEAR(slope / 2, 2 * hurst, 0.25) << hurst;
  }
}

TEST(WithRoughness, WavesAreLongerAlongItsDirection) {
  const HeightField plain = oblong();
  const RoughnessTag tag{2.5, 2e-5, {1e-3, 4e-3}, 4, M_PI / 2, true};  // Along v.
  const HeightField rough = with_roughness(plain, tag, k_oblong_m, 5);
  EXPECT_GT(structure(rough, plain, {3e-4, 0}), 4 * structure(rough, plain, {0, 3e-4}));
}

TEST(WithRoughness, WavesAtAnObliqueDirectionAreLongerAlongIt) {
  const HeightField plain = oblong();
  const RoughnessTag tag{2.5, 2e-5, {1e-3, 4e-3}, 4, M_PI / 4, true};
  const HeightField rough = with_roughness(plain, tag, k_oblong_m, 5);
  EXPECT_GT(structure(rough, plain, {-3e-4, 3e-4}), 4 * structure(rough, plain, {3e-4, 3e-4}));
}

TEST(WithRoughness, IsTheSameAlongBothSidesOfAnOblongRelief) {
  const HeightField plain = oblong();
  double along_u = 0, along_v = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const HeightField rough = with_roughness(plain, {2.5, 2e-5, {1e-3, 8e-3}, 1, 0, true}, k_oblong_m, seed);
    along_u += structure(rough, plain, {5e-4, 0}), along_v += structure(rough, plain, {0, 5e-4});
  }
  EXPECT_NEAR(along_u / along_v, 1, 0.15);
}

TEST(WithRoughness, TheFewerSamplesOfEitherSideAreRefined) {
  // Texels of 0.25 × 0.8 mm: the shortest wave has four samples down a column.
  const HeightField rough = with_roughness(oblong(), {2.5, 2e-5, {6e-4, 5e-3}}, {0.024, 0.048}, 3);
  EXPECT_EQ(rough.width(), 6 * 96);
  EXPECT_EQ(rough.height(), 6 * 60);
}

TEST(WithRoughness, RefusesWhatIsNoLength) {
  EXPECT_THROW(with_roughness(oblong(), {2.5, 1e-5, {0, 1e-3}}, k_oblong_m, 1), InvalidInput);
  EXPECT_THROW(with_roughness(oblong(), {2.5, 1e-5, {1e-4, 1e-3}, 0.5}, k_oblong_m, 1), InvalidInput);
  EXPECT_THROW(with_roughness(oblong(), {2.5, 1e-5, {1e-4, 1e-3}}, {0, 1}, 1), InvalidInput);
}

}  // namespace
}  // namespace papilla
