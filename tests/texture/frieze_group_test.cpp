// SPDX-License-Identifier: MIT
#include "papilla/texture/frieze_group.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "papilla/core/error.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

constexpr double k_pi = std::numbers::pi;

/// A motif without symmetry, u in periods, v from −1 to 1.
double motif(double u, double v) {
  const double w = 2 * k_pi * u;
  return std::cos(w) + 0.6 * std::sin(2 * w + 1.3 * v) + 0.7 * v * std::cos(w - 2) + 0.5 * std::cos(3 * w + 2 * v) +
         0.4 * std::sin(2.5 * v) * std::sin(2 * w);
}

/// The motif averaged over a group, as the definitions have it.
double averaged(FriezeGroup group, double u, double v) {
  using enum FriezeGroup;
  switch (group) {
    case p1: return motif(u, v);
    case p11g: return motif(u, v) + motif(u + 0.5, -v);
    case p1m1: return motif(u, v) + motif(-u, v);
    case p2: return motif(u, v) + motif(-u, -v);
    case p2mg: return motif(u, v) + motif(-u, v) + motif(u + 0.5, -v) + motif(0.5 - u, -v);
    case p11m: return motif(u, v) + motif(u, -v);
    case p2mm: return motif(u, v) + motif(-u, v) + motif(u, -v) + motif(-u, -v);
  }
  return 0;
}

GreyImage strip(FriezeGroup group, double period, double axis, double noise) {
  const GreyImage random = test::noise_image(200, 40, 3);
  return test::make_image(200, 40, [&](int x, int y) {
    return 0.5 + 0.08 * averaged(group, (x - 7.3) / period, (y - axis) / 20) +
           noise * (static_cast<double>(random.at(x, y)) - 0.5);
  });
}

TEST(FriezeGroup, AllSevenAreFound) {
  for (int i = 0; i < 7; ++i) {
    const auto group = static_cast<FriezeGroup>(i);
    for (const double noise : {0.0, 0.2}) {
      const FriezeSymmetry found = find_frieze_group(strip(group, 23.7, 20.5, noise));
      ASSERT_TRUE(found.found) << to_string(group);
      EXPECT_EQ(to_string(found.group), to_string(group)) << "noise " << noise;
      EXPECT_NEAR(found.period_px, 23.7, 0.1);
      if (group != FriezeGroup::p1 && group != FriezeGroup::p1m1) {
        EXPECT_NEAR(found.axis_y, 20.5, 0.5) << to_string(group);
      }
      if (group == FriezeGroup::p1m1 || group == FriezeGroup::p2mm) {
        EXPECT_LT(std::abs(std::remainder(found.origin_x - 7.3, 23.7 / 2)), 0.3) << to_string(group);
      }
    }
  }
}

TEST(FriezeGroup, NoneInNoiseAndFlatStrips) {
  EXPECT_FALSE(find_frieze_group(test::noise_image(200, 30, 1)).found);
  EXPECT_FALSE(find_frieze_group(test::make_image(60, 20, [](int, int) { return 0.5; })).found);
  EXPECT_FALSE(find_frieze_group(test::noise_image(3, 1, 1)).found);
  EXPECT_THROW(find_frieze_group(GreyImage{}), InvalidInput);
}

/// n petals, bent unless mirrors are wanted.
GreyImage rosette(int n, bool mirrors, Vec2 centre) {
  return test::make_image(97, 93, [&](int x, int y) {
    const double dx = x - centre.x, dy = y - centre.y, r = std::hypot(dx, dy), angle = std::atan2(dy, dx);
    const double twist = mirrors ? 0.0 : 0.08 * r;
    return 0.5 +
           0.3 * std::exp(-r * r / 900) * (std::cos(n * (angle - 0.3) + twist) + 0.5 * std::cos(2 * n * (angle - 0.3)));
  });
}

TEST(RosetteGroup, RotationsAndMirrorsAreFound) {
  for (const int n : {1, 3, 4, 8})
    for (const bool mirrors : {false, true}) {
      const RosetteSymmetry found = find_rosette_group(rosette(n, mirrors, {47, 45.5}), {48, 46});
      EXPECT_EQ(found.name(), (mirrors ? "d" : "c") + std::to_string(n));
      if (n >= 3) {
        EXPECT_NEAR(found.centre_px.x, 47, 0.5) << found.name();
        EXPECT_NEAR(found.centre_px.y, 45.5, 0.5) << found.name();
      }
      EXPECT_NEAR(found.sector_deg, 360.0 / n / (mirrors ? 2 : 1), 1e-9);
    }
}

/// Dots on two rings, one pair a sector: unlike waves, many harmonics and nothing in between.
GreyImage dotted_rosette(int n, bool mirrors, Vec2 centre) {
  return test::make_image(97, 97, [&](int x, int y) {
    double sum = 0;
    const auto add = [&](double radius, double angle, double width) {
      const double dx = x - centre.x - radius * std::cos(angle), dy = y - centre.y - radius * std::sin(angle);
      sum += std::exp(-(dx * dx + dy * dy) / (2 * width * width));
    };
    for (int k = 0; k < n; ++k)
      for (const int side : mirrors ? std::vector{1, -1} : std::vector{1}) {
        const double sector = 0.3 + 2 * std::numbers::pi * k / n;
        add(30, sector + side * 1.1 / n, 4.3);
        add(39, sector + side * (mirrors ? 0.6 : 2.2) / n, 3);
      }
    return 0.5 + 0.3 * sum;
  });
}

/// Normal noise of half the picture's own deviation.
GreyImage noisy(GreyImage image, unsigned seed) {
  double mean = 0, squares = 0;
  const auto count = static_cast<double>(image.pixels.size());
  for (const float v : image.pixels) mean += static_cast<double>(v) / count;
  for (const float v : image.pixels) squares += (static_cast<double>(v) - mean) * (static_cast<double>(v) - mean);
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0, 0.5 * std::sqrt(squares / count));
  for (float& v : image.pixels) v = static_cast<float>(static_cast<double>(v) + normal(engine));
  return image;
}

class NoisyRosette : public testing::TestWithParam<int> {};

TEST_P(NoisyRosette, IsFound) {
  const int n = GetParam();
  for (const bool mirrors : {false, true}) {
    const std::string name = (mirrors ? "d" : "c") + std::to_string(n);
    EXPECT_EQ(find_rosette_group(noisy(rosette(n, mirrors, {47, 45.5}), 1), {48, 46}).name(), name);
    if (n < 3) continue;
    EXPECT_EQ(find_rosette_group(noisy(dotted_rosette(n, mirrors, {47, 48.5}), 2), {48, 48}).name(), name);
  }
}

INSTANTIATE_TEST_SUITE_P(AllOrders, NoisyRosette, testing::Range(1, 13));

TEST(RosetteGroup, RefusesBadArguments) {
  EXPECT_THROW(find_rosette_group(test::noise_image(8, 8, 1), {4, 4}), InvalidInput);
  EXPECT_THROW(find_rosette_group(test::noise_image(32, 32, 1), {1, 16}), InvalidInput);
  EXPECT_EQ(find_rosette_group(test::make_image(32, 32, [](int, int) { return 0.5; }), {16, 16}).rotations, 1);
}

}  // namespace
}  // namespace papilla
