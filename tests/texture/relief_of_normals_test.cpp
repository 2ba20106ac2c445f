// SPDX-License-Identifier: MIT
#include "papilla/texture/relief_of_normals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/texture/normal_map.hpp"

namespace papilla {
namespace {

TEST(ReliefOfNormals, IsTheInverseOfTheNormalMap) {
  // Waves of 48 to 8 texels, on unlike pitches.
  HeightMap relief{48, 40, Values<float>(48 * 40), 0.1, 0.15, true};
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 48; ++x) {
      const double u = 2 * std::numbers::pi * x / 48, v = 2 * std::numbers::pi * y / 40;
      relief.at(x, y) =
          static_cast<float>(0.3 * std::sin(u) + 0.1 * std::cos(3 * v + u) + 0.02 * std::sin(6 * u) * std::sin(5 * v));
    }
  const HeightMap found = relief_of_normals(normal_map(relief), 1, 0.1, 0.15);
  double worst = 0;
  for (std::size_t i = 0; i < relief.mm.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(found.mm[i] - relief.mm[i])));
  EXPECT_LT(worst, 0.006);
  EXPECT_TRUE(found.periodic);
}

TEST(ReliefOfNormals, TheScaleMultipliesTheSlopes) {
  HeightMap relief{32, 8, Values<float>(32 * 8), 1, 1, true};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 32; ++x) relief.at(x, y) = static_cast<float>(std::sin(2 * std::numbers::pi * x / 32));
  const HeightMap half = relief_of_normals(normal_map(relief), 0.5, 1, 1);
  for (int x = 0; x < 32; ++x) EXPECT_NEAR(half.at(x, 3), 0.5F * relief.at(x, 3), 0.01);
}

TEST(ReliefOfNormals, AFlatMapIsFlatAndBadOnesAreRefused) {
  const ColorImage flat{
      3, 2, {128, 128, 255, 128, 128, 255, 128, 128, 255, 128, 128, 255, 128, 128, 255, 128, 128, 255}};
  for (const float h : relief_of_normals(flat, 1, 1, 1).mm) EXPECT_EQ(h, 0);
  const ColorImage inwards{2, 2, Values<unsigned char>(12, 0)};
  for (const float h : relief_of_normals(inwards, 1, 1, 1).mm) EXPECT_TRUE(std::isfinite(h));
  EXPECT_THROW(relief_of_normals({}, 1, 1, 1), InvalidInput);
  EXPECT_THROW(relief_of_normals(flat, 1, 0, 1), InvalidInput);
  EXPECT_THROW(relief_of_normals(flat, std::numeric_limits<double>::infinity(), 1, 1), InvalidInput);
}

}  // namespace
}  // namespace papilla
