// SPDX-License-Identifier: MIT
#include "papilla/param/seam_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

/// A square of side 10 as two triangles; on request the second one's uv lie apart.
TriangleMesh square() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Flattening map_of_square(double scale, bool apart) {
  Flattening f;
  const Vec2 shift{apart ? 50.0 : 0.0, 0};
  f.uv.values = {{0, 0},
                 {scale * 10, 0},
                 {scale * 10, scale * 10},
                 shift,
                 shift + scale * Vec2{10, 10},
                 shift + scale * Vec2{0, 10}};
  f.uv.indices = {{0, 1, 2}, {3, 4, 5}};
  f.charts.of_triangle = {0, apart ? 1u : 0u};
  f.charts.count = apart ? 2 : 1;
  return f;
}

/// What a map that scales by s costs: 2 (s² + 1 / s²) - 4.
double distortion(double s) { return 2 * (s * s + 1 / (s * s)) - 4; }

TEST(SeamChoice, FewerSeamsAreTriedWhereLittleIsDistorted) {
  const auto map = [](double cost) { return cost < 0.05 ? map_of_square(1, true) : map_of_square(1.01, false); };
  const SeamChoice choice = choose_seam_cost(square(), map);
  ASSERT_EQ(choice.trials.size(), 2u);
  EXPECT_EQ(choice.trials[0].seam_cost, 0.03);
  EXPECT_EQ(choice.trials[1].seam_cost, 0.1);
  EXPECT_NEAR(choice.trials[0].seam, std::sqrt(2.0), 1e-12);  // the diagonal over the side
  EXPECT_NEAR(choice.trials[0].distortion, 0, 1e-12);
  EXPECT_NEAR(choice.trials[0].price, 1e-4 * std::pow(1 + std::sqrt(2.0), 5), 1e-9);
  EXPECT_EQ(choice.trials[1].seam, 0);
  EXPECT_NEAR(choice.trials[1].price, distortion(1.01) + 1e-4, 1e-9);
  EXPECT_EQ(choice.chosen, 1u);
  EXPECT_EQ(choice.flattening.charts.count, 1u);
}

TEST(SeamChoice, MoreSeamsAreTriedWhereMuchIsDistorted) {
  const auto map = [](double cost) { return cost < 0.02 ? map_of_square(1, true) : map_of_square(1.1, false); };
  const SeamChoice choice = choose_seam_cost(square(), map);
  EXPECT_EQ(choice.trials[1].seam_cost, 0.01);
  EXPECT_NEAR(choice.trials[0].distortion, distortion(1.1), 1e-12);
  EXPECT_EQ(choice.chosen, 1u);
  EXPECT_EQ(choice.flattening.charts.count, 2u);
}

TEST(SeamChoice, FewerSeamsAreTriedWhereMoreAreNoBetter) {
  // Much is distorted, and seams do not help.
  std::vector<double> tried;
  const auto map = [&](double cost) { return tried.push_back(cost), map_of_square(1.1, cost < 0.05); };
  const SeamChoice choice = choose_seam_cost(square(), map);
  EXPECT_EQ(tried, (std::vector<double>{0.03, 0.01, 0.1}));
  EXPECT_EQ(choice.chosen, 2u);
  EXPECT_EQ(choice.flattening.charts.count, 1u);
}

TEST(SeamChoice, FewerSeamsThatDistortPlainlyHaveToSaveThreeQuarters) {
  const auto map_to = [](double scale) {
    return [scale](double cost) { return map_of_square(cost < 0.05 ? 1.05 : scale, cost < 0.05); };
  };
  // Without the seam P is divided by (1 + √2)⁵ = 82.
  const double usual = distortion(1.05) * std::pow(1 + std::sqrt(2.0), 5);
  ASSERT_GT(distortion(1.2), 0.1);
  ASSERT_LT(distortion(1.2), 0.24 * usual);
  EXPECT_EQ(choose_seam_cost(square(), map_to(1.2)).chosen, 2u);
  ASSERT_GT(distortion(1.5), 0.26 * usual);
  ASSERT_LT(distortion(1.5), usual);
  EXPECT_EQ(choose_seam_cost(square(), map_to(1.5)).chosen, 0u);
}

TEST(SeamChoice, TheUsualOneStaysAtEquality) {
  const SeamChoice choice = choose_seam_cost(square(), [](double) { return map_of_square(1, false); });
  EXPECT_EQ(choice.trials[0].price, choice.trials[1].price);
  EXPECT_EQ(choice.chosen, 0u);
}

TEST(SeamChoice, FlippedMapsArePassedOver) {
  const auto map = [](double cost) { return map_of_square(cost == 0.03 ? 1 : -1, cost == 0.03); };
  const SeamChoice turned = choose_seam_cost(square(), map);  // a turn by 180° is no flip
  EXPECT_EQ(turned.chosen, 1u);
  const auto mirror = [](double cost) {
    Flattening f = map_of_square(1, cost == 0.03);
    if (cost != 0.03)
      for (Vec2& p : f.uv.values) p.x = -p.x;
    return f;
  };
  const SeamChoice mirrored = choose_seam_cost(square(), mirror);
  EXPECT_TRUE(std::isinf(mirrored.trials[1].distortion));
  EXPECT_EQ(mirrored.chosen, 0u);
}

TEST(SeamChoice, UvThatDoNotFitAreNamed) {
  EXPECT_THROW(choose_seam_cost(square(), [](double) { return Flattening{}; }), InvalidInput);
}

}  // namespace
}  // namespace papilla
