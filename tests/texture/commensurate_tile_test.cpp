// SPDX-License-Identifier: MIT
#include "papilla/texture/commensurate_tile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/texture/tiling.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

using Basis = std::array<Vec2, 2>;

/// A cell of these lengths with that angle between its sides, turned.
Basis turned(double a, double b, double between_deg, double by_deg) {
  const auto at = [](double length, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return Vec2{length * std::cos(angle), length * std::sin(angle)};
  };
  return {at(a, by_deg), at(b, by_deg + between_deg)};
}

GreyImage cell() {
  return test::make_image(24, 20, [](int x, int y) {
    const double u = 2 * std::numbers::pi * x / 24, v = 2 * std::numbers::pi * y / 20;
    return 0.5 + 0.2 * std::cos(u) * std::cos(v) + 0.1 * std::sin(2 * u + v);
  });
}

TEST(CommensurateTile, UprightCellsOfWholePixelsAreTheirOwn) {
  const CommensurateTile tile = find_commensurate_tile({Vec2{40, 0}, Vec2{0, 36}});
  EXPECT_EQ(tile.width, 40);
  EXPECT_EQ(tile.height, 36);
  EXPECT_EQ(tile.strain, 0);
  EXPECT_EQ(tile.combination, (std::array<std::array<int, 2>, 2>{{{1, 0}, {0, 1}}}));
}

TEST(CommensurateTile, FractionalPeriodsTakeSeveralCells) {
  const CommensurateTile tile = find_commensurate_tile({Vec2{7.4, 0}, Vec2{0, 36}});
  EXPECT_EQ(tile.width, 37);
  EXPECT_EQ(tile.combination[0], (std::array{5, 0}));
}

TEST(CommensurateTile, HexagonalCellsFindTheirRectangle) {
  // 2 b − a is upright: √3 · 40 = 69.28 high.
  const CommensurateTile tile = find_commensurate_tile(turned(40, 40, 60, 0));
  EXPECT_EQ(tile.width, 40);
  EXPECT_EQ(tile.height, 69);
  EXPECT_NEAR(tile.strain, 69.282 / 69 - 1, 1e-3);
}

TEST(CommensurateTile, AnyLatticeFitsWithinOnePercent) {
  for (const double between : {60.0, 75.0, 90.0, 104.0})
    for (int angle = -44; angle <= 44; angle += 4) {
      const Basis basis = turned(31.3, 42.7, between, angle);
      const CommensurateTile tile = find_commensurate_tile(basis);
      EXPECT_LE(tile.strain, 0.01) << between << " turned by " << angle;
      // The tile is the combination of the vectors it says.
      const auto& c = tile.combination;
      const Vec2 right = static_cast<double>(c[0][0]) * basis[0] + static_cast<double>(c[0][1]) * basis[1];
      const Vec2 down = static_cast<double>(c[1][0]) * basis[0] + static_cast<double>(c[1][1]) * basis[1];
      EXPECT_LE(norm(right - Vec2{static_cast<double>(tile.width), 0}), 0.0101 * tile.width);
      EXPECT_LE(norm(down - Vec2{0, static_cast<double>(tile.height)}), 0.0101 * tile.height);
    }
}

TEST(CommensurateTile, RepeatsToTheLastBit) {
  for (const int angle : {0, 17, -33}) {
    const CommensurateTile tile = find_commensurate_tile(turned(31.3, 42.7, 75, angle));
    CommensurateTile twice = tile;
    twice.width *= 2;
    twice.height *= 2;
    for (auto& side : twice.combination)
      for (int& count : side) count *= 2;
    const GreyImage one = fill_tile(cell(), tile), four = fill_tile(cell(), twice);
    for (int y = 0; y < four.height; ++y)
      for (int x = 0; x < four.width; ++x)
        ASSERT_EQ(four.at(x, y), one.at(x % tile.width, y % tile.height)) << angle << ": " << x << ", " << y;
    EXPECT_TRUE(measure_tiling(one).tiles) << angle;
  }
}

TEST(CommensurateTile, RefusesWhatSpansNoTile) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(find_commensurate_tile({Vec2{10, 0}, Vec2{20, 0}}), InvalidInput);
  EXPECT_THROW(find_commensurate_tile({Vec2{nan, 0}, Vec2{0, 20}}), InvalidInput);
  EXPECT_THROW(find_commensurate_tile({Vec2{9000, 0}, Vec2{0, 9000}}), InvalidInput);
  EXPECT_THROW(find_commensurate_tile({Vec2{10, 0}, Vec2{0, 10}}, {.most_strain = 0}), InvalidInput);
  EXPECT_THROW(fill_tile(cell(), {}), InvalidInput);
  EXPECT_THROW(fill_tile({}, {.width = 8, .height = 8}), InvalidInput);
}

}  // namespace
}  // namespace papilla
