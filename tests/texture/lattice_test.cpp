// SPDX-License-Identifier: MIT
#include "papilla/texture/lattice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

/// A random periodic picture with known lattice.
struct Pattern {
  Vec2 a, b;
  GreyImage image;
};

Pattern random_pattern(unsigned seed, double noise) {
  std::mt19937 engine(seed);
  const auto uniform = [&] { return static_cast<double>(engine()) / 4294967296.0; };
  const auto normal = [&] {
    double sum = 0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum - 6;
  };
  const double length = 18 + 25 * uniform(), turn = 2 * std::numbers::pi * uniform();
  const double angle = seed % 3 == 0 ? std::numbers::pi / 2 : (60 + 60 * uniform()) * std::numbers::pi / 180;
  const double other = seed % 6 == 0 ? length : length * (1 + 0.4 * uniform());
  Pattern pattern;
  pattern.a = {length * std::cos(turn), length * std::sin(turn)};
  pattern.b = {other * std::cos(turn + angle), other * std::sin(turn + angle)};
  struct Wave {
    double m, n, amplitude, phase;
  };
  std::vector<Wave> waves;
  for (int n = 0; n <= 3; ++n)
    for (int m = -3; m <= 3; ++m)
      if (n > 0 || m > 0)
        waves.push_back({static_cast<double>(m), static_cast<double>(n), normal() * std::exp(-0.1 * (m * m + n * n)),
                         2 * std::numbers::pi * uniform()});
  double power = 0;
  for (const Wave& wave : waves) power += wave.amplitude * wave.amplitude / 2;
  const double area = cross(pattern.a, pattern.b);
  pattern.image = test::make_image(
      192, 192,
      [&](int x, int y) {
        const Vec2 p{static_cast<double>(x), static_cast<double>(y)};
        const double u = cross(p, pattern.b) / area, v = cross(pattern.a, p) / area;
        double value = 0;
        for (const Wave& wave : waves)
          value += wave.amplitude * std::cos(2 * std::numbers::pi * (wave.m * u + wave.n * v) + wave.phase);
        return std::round(std::clamp(128 + 30 * (value / std::sqrt(power) + noise * normal()), 0.0, 255.0)) / 255;
      },
      8);
  return pattern;
}

/// Distance of the found vectors from the nearest true lattice vectors; huge when they span another lattice.
double lattice_error(const Lattice& lattice, Vec2 a, Vec2 b) {
  if (!lattice.found) return 1e9;
  const double area = cross(a, b);
  Vec2 whole[2];
  double worst = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec2 t = lattice.vectors_px[i];
    whole[i] = {std::round(cross(t, b) / area), std::round(cross(a, t) / area)};
    worst = std::max(worst, norm(whole[i].x * a + whole[i].y * b - t));
  }
  return std::abs(cross(whole[0], whole[1])) == 1 ? worst : 1e9;
}

class RandomLattices : public testing::TestWithParam<double> {};

TEST_P(RandomLattices, AreFoundToSubPixelAccuracy) {
  constexpr int k_patterns = 30;
  std::vector<double> errors;
  for (unsigned seed = 0; seed < k_patterns; ++seed) {
    const Pattern pattern = random_pattern(seed, GetParam());
    errors.push_back(lattice_error(find_lattice(feature_matrix(pattern.image)), pattern.a, pattern.b));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[k_patterns / 2], 0.04);
  EXPECT_LT(errors[k_patterns - 2], 1) << "more than one lattice of thirty is wrong";
}

INSTANTIATE_TEST_SUITE_P(Noise, RandomLattices, testing::Values(0.0, 0.5, 1.0));

TEST(Lattice, VectorsAreReducedAndOriented) {
  // Given by a long oblique basis of the lattice of (12, 0) and (4, 14).
  const GreyImage image = test::make_image(160, 160, [](int x, int y) {
    const double v = y / 14.0, u = (x - 4 * v) / 12;
    return 0.5 + 0.2 * std::cos(2 * std::numbers::pi * u) + 0.2 * std::cos(2 * std::numbers::pi * v) +
           0.1 * std::sin(2 * std::numbers::pi * (u + v));
  });
  const Lattice lattice = find_lattice(feature_matrix(image));
  ASSERT_TRUE(lattice.found) << lattice.reason;
  EXPECT_NEAR(lattice.vectors_px[0].x, 12, 0.02);
  EXPECT_NEAR(lattice.vectors_px[0].y, 0, 0.02);
  EXPECT_NEAR(lattice.vectors_px[1].x, 4, 0.02);
  EXPECT_NEAR(lattice.vectors_px[1].y, 14, 0.02);
  EXPECT_GT(lattice.significance, 0.8);
}

TEST(Lattice, TheProjectionMethodFindsCleanLatticesToAPixel) {
  const GreyImage image = test::make_image(160, 160, [](int x, int y) {
    const double v = y / 15.0, u = (x - 6 * v) / 20;
    return 0.5 + 0.2 * std::cos(2 * std::numbers::pi * u) + 0.2 * std::cos(2 * std::numbers::pi * v);
  });
  const Lattice lattice = find_lattice(feature_matrix(image), {.method = LatticeMethod::projection});
  ASSERT_TRUE(lattice.found) << lattice.reason;
  EXPECT_LT(lattice_error(lattice, {20, 0}, {6, 15}), 1);
}

TEST(Lattice, NoneInFractalSurfaces) {
  for (const double hurst : {0.1, 0.5, 0.9})
    for (std::uint64_t seed = 1; seed <= 8; ++seed)
      EXPECT_FALSE(find_lattice(feature_matrix(to_grey_image(brownian_surface_exact({160, hurst, seed}), 8))).found)
          << "H " << hurst << " seed " << seed;
}

TEST(Lattice, NoneInNoise) {
  for (unsigned seed = 1; seed <= 20; ++seed)
    EXPECT_FALSE(find_lattice(feature_matrix(test::noise_image(64 + 8 * static_cast<int>(seed), 128, seed))).found)
        << seed;
}

TEST(Lattice, StripesAreNone) {
  const Lattice lattice = find_lattice(
      feature_matrix(test::make_image(128, 128, [](int x, int y) { return 0.5 + 0.4 * std::sin(0.5 * x + 0.2 * y); })));
  EXPECT_FALSE(lattice.found);
  EXPECT_FALSE(lattice.reason.empty());
}

/// Maps much wider than high: the cell's second vector may end above them, where nothing can be looked up. A cosine of
/// angular frequency f is smoothed by the map's binomial to cos⁴(f/2); the noise takes about a fifth.
TEST(Lattice, StripesOfLowMapsHaveTheCorrelationOfTheirWave) {
  int striped = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    std::mt19937 random(seed);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    FeatureMatrix matrix;
    matrix.reach_x = 20 + static_cast<int>(random() % 40);
    matrix.reach_y = 5 + static_cast<int>(random() % 8);
    const double frequency = 2 * std::numbers::pi / (6 + 6 * uniform());
    for (int y = -matrix.reach_y; y <= matrix.reach_y; ++y)
      for (int x = -matrix.reach_x; x <= matrix.reach_x; ++x)
        matrix.distortion.push_back(x == 0 && y == 0 ? 0 : 1 - 0.9 * std::cos(frequency * x) + 0.2 * uniform());
    const Lattice lattice = find_lattice(matrix, {.least_significance = 0.05});
    if (lattice.stripes == 0) continue;
    ++striped;
    EXPECT_NEAR(lattice.stripes / std::pow(std::cos(frequency / 2), 4), 0.8, 0.1) << seed;
  }
  EXPECT_GT(striped, 350);
}

TEST(Lattice, NoneInFlatAndTinyPictures) {
  EXPECT_FALSE(find_lattice(feature_matrix(test::make_image(64, 64, [](int, int) { return 0.5; }))).found);
  for (const auto& [w, h] : {std::pair{1, 1}, std::pair{1, 50}, std::pair{7, 7}})
    EXPECT_FALSE(find_lattice(feature_matrix(test::noise_image(w, h, 1))).found);
}

TEST(Lattice, RefusesBadArguments) {
  const FeatureMatrix matrix = feature_matrix(test::noise_image(16, 16, 1));
  EXPECT_THROW(find_lattice(matrix, {.least_significance = 0}), InvalidInput);
  EXPECT_THROW(find_lattice(matrix, {.most_candidates = 1}), InvalidInput);
  EXPECT_THROW(find_lattice(FeatureMatrix{}), InvalidInput);
}

}  // namespace
}  // namespace papilla
