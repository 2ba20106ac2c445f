// SPDX-License-Identifier: MIT
#include "papilla/texture/surface_like.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

TEST(SurfaceLike, MeetsTheSignatureOfAnotherSurface) {
  for (const double hurst : {0.3, 0.7}) {
    const SurfaceLike like = surface_like(to_grey_image(brownian_surface_exact({129, hurst, 5})), {.size = 128});
    EXPECT_NEAR(like.achieved.sta, like.target.sta, 0.04) << hurst;
    EXPECT_NEAR(like.achieved.str, like.target.str, 0.15) << hurst;
    EXPECT_TRUE(like.surface.periodic);
  }
}

TEST(SurfaceLike, TakesTheRmsOfThePicture) {
  const GreyImage image = test::noise_image(100, 70, 3);
  double mean = 0, squares = 0, found = 0;
  for (const float grey : image.pixels) mean += static_cast<double>(grey) / 7000;
  for (const float grey : image.pixels) squares += std::pow(static_cast<double>(grey) - mean, 2) / 7000;
  const SurfaceLike like = surface_like(image, {.size = 64, .rounds = 2});
  for (const double height : like.surface.heights) found += height * height / (64 * 64);
  EXPECT_NEAR(found, squares, 1e-9);
}

TEST(SurfaceLike, RefusesBadArguments) {
  EXPECT_THROW(surface_like(test::noise_image(63, 80, 1)), InvalidInput);
  EXPECT_THROW(surface_like(test::noise_image(64, 64, 1), {.size = 32}), InvalidInput);
  EXPECT_THROW(surface_like(test::noise_image(64, 64, 1), {.rounds = 0}), InvalidInput);
}

}  // namespace
}  // namespace papilla
