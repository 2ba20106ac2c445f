// SPDX-License-Identifier: MIT
#include "papilla/texture/fshot_dimension.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

TEST(FshotDimension, PowerOfTheDistanceIsItsExponent) {
  // |z(x) − z(x + r)| is largest across the vertex: r^0.6 in every direction that has one.
  const GreyImage cone =
      test::make_image(96, 96, [](int x, int y) { return std::pow(std::hypot(x - 48, y - 48), 0.6); });
  const FshotSignature signature = fshot_dimension(cone);
  EXPECT_NEAR(signature.sta, 0.6, 1e-6);
  EXPECT_NEAR(signature.str, 1, 1e-6);
  EXPECT_NEAR(signature.fs_h, 2.4, 1e-6);
  EXPECT_NEAR(signature.fs_v, 2.4, 1e-6);
  for (const DirectionalHurst& direction : signature.directions) EXPECT_NEAR(direction.hurst, 0.6, 1e-6);
}

TEST(FshotDimension, RoughRowsGiveTheMinorAxis) {
  // Rough along x, smooth along y.
  const GreyImage noise = test::noise_image(128, 1, 7);
  const GreyImage image =
      test::make_image(128, 128, [&](int x, int y) { return static_cast<double>(noise.at(x, 0)) + 0.2 * y; });
  const FshotSignature signature = fshot_dimension(image);
  EXPECT_LT(signature.str, 0.6);
  EXPECT_LT(std::min(signature.angle_deg, 180 - signature.angle_deg), 20);
  EXPECT_GT(signature.fs_h, signature.fs_v);
}

TEST(FshotDimension, ScaleAndOffsetDoNotMatter) {
  const GreyImage image = to_grey_image(brownian_surface_exact({65, 0.5, 2}));
  GreyImage scaled = image;
  for (float& grey : scaled.pixels) grey = 7 * grey - 3;
  const FshotSignature a = fshot_dimension(image), b = fshot_dimension(scaled);
  EXPECT_NEAR(a.sta, b.sta, 1e-5);
  EXPECT_NEAR(a.angle_deg, b.angle_deg, 0.1);
  EXPECT_LE(a.estimate.low, a.estimate.dimension);
  EXPECT_GE(a.estimate.high, a.estimate.dimension);
}

TEST(FshotDimension, FlatIsAPlaneAndBadInputIsRefused) {
  const FshotSignature flat = fshot_dimension(test::make_image(40, 40, [](int, int) { return 0.5; }));
  EXPECT_EQ(flat.sta, 1);
  EXPECT_EQ(flat.estimate.dimension, 2);
  EXPECT_THROW(fshot_dimension(test::noise_image(31, 64, 1)), InvalidInput);
  GreyImage bad = test::noise_image(40, 40, 1);
  bad.at(3, 3) = std::nanf("");
  EXPECT_THROW(fshot_dimension(bad), InvalidInput);
}

}  // namespace
}  // namespace papilla
