// SPDX-License-Identifier: MIT
#include "papilla/texture/height_from_image.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "papilla/core/error.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

double correlation(const HeightMap& a, const HeightMap& b) {
  double mean_a = 0, mean_b = 0, ab = 0, aa = 0, bb = 0;
  const auto n = static_cast<double>(a.mm.size());
  for (std::size_t i = 0; i < a.mm.size(); ++i) {
    mean_a += static_cast<double>(a.mm[i]) / n;
    mean_b += static_cast<double>(b.mm[i]) / n;
  }
  for (std::size_t i = 0; i < a.mm.size(); ++i) {
    const double u = static_cast<double>(a.mm[i]) - mean_a, v = static_cast<double>(b.mm[i]) - mean_b;
    ab += u * v;
    aa += u * u;
    bb += v * v;
  }
  return ab / std::sqrt(aa * bb);
}

TEST(HeightFromImage, GivesBackTheReliefOfALitGrain) {
  for (const GrainKind kind : {GrainKind::spheres6, GrainKind::quads6, GrainKind::ovals6}) {
    const GrainResult grain = synthesize_grain(kind, {192});
    const HeightResult result = height_from_image(grain.picture);  // Everything automatic.
    EXPECT_EQ(result.method, HeightMethod::variational) << to_string(kind);
    EXPECT_TRUE(result.map.periodic) << to_string(kind);
    EXPECT_TRUE(result.light_estimated);
    EXPECT_GT(correlation(result.map, grain.relief), 0.75) << to_string(kind);
    // The true light in place of the estimated one.
    const HeightResult lit = height_from_image(grain.picture, {.light = GrainOptions{}.light});
    EXPECT_FALSE(lit.light_estimated);
    EXPECT_GT(correlation(lit.map, grain.relief), 0.85) << to_string(kind);
    EXPECT_FALSE(result.trace.empty());
  }
}

TEST(HeightFromImage, HasTheDepthAskedFor) {
  const HeightResult result = height_from_image(synthesize_grain(GrainKind::spheres6, {96}).picture, {.depth_mm = 0.7});
  const auto [low, high] = std::minmax_element(result.map.mm.begin(), result.map.mm.end());
  EXPECT_EQ(*low, 0);
  EXPECT_NEAR(*high, 0.7, 1e-6);
  EXPECT_EQ(result.depth_mm, 0.7);
  EXPECT_DOUBLE_EQ(result.rms_mm, rms_height_mm(result.map));
  EXPECT_NEAR(result.map.pitch_mm_x, 40.0 / 96, 1e-12);
}

TEST(HeightFromImage, DisorderedPicturesAreReadAsHeights) {
  const GreyImage image = to_grey_image(brownian_surface_exact({97, 0.5, 2}));
  const HeightResult result = height_from_image(image, {.pitch_mm = 0.1, .depth_mm = 2});
  EXPECT_EQ(result.method, HeightMethod::intensity);
  EXPECT_FALSE(result.map.periodic);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) ASSERT_NEAR(result.map.mm[i], 2 * image.pixels[i], 1e-6);
}

TEST(HeightFromImage, UnknownPitchStaysUnknown) {
  GreyImage image = test::noise_image(40, 40, 1);
  EXPECT_EQ(height_from_image(image).map.pitch_mm_x, 0);
  image.pitch_mm = 0.25;
  EXPECT_EQ(height_from_image(image).map.pitch_mm_x, 0.25);
  EXPECT_EQ(height_from_image(image, {.pitch_mm = 0.5}).map.pitch_mm_y, 0.5);
}

TEST(HeightFromImage, FlatAndBlackPicturesAreFlat) {
  for (const double grey : {0.0, 0.5, 1.0})
    for (const HeightMethod method :
         {HeightMethod::automatic, HeightMethod::variational, HeightMethod::tsai_shah, HeightMethod::intensity}) {
      const HeightResult result =
          height_from_image(test::make_image(20, 15, [=](int, int) { return grey; }), {.method = method});
      EXPECT_EQ(result.depth_mm, 0);
      EXPECT_EQ(result.rms_mm, 0);
      for (const float height : result.map.mm) EXPECT_EQ(height, 0);
    }
}

TEST(HeightFromImage, AlwaysFinite) {
  for (const auto& [w, h] : {std::pair{1, 1}, std::pair{1, 30}, std::pair{30, 1}, std::pair{3, 2}, std::pair{33, 20}})
    for (const HeightMethod method : {HeightMethod::variational, HeightMethod::tsai_shah, HeightMethod::intensity})
      for (const Vec3 light : {Vec3{0, 0, 1}, Vec3{1, -1, 0.01}}) {
        const HeightResult result = height_from_image(test::noise_image(w, h, 3), {.method = method, .light = light});
        for (const float height : result.map.mm) ASSERT_TRUE(std::isfinite(height));
      }
}

TEST(HeightFromImage, RefusesBadArguments) {
  const GreyImage image = test::noise_image(8, 8, 1);
  EXPECT_THROW(height_from_image(GreyImage{}), InvalidInput);
  EXPECT_THROW(height_from_image(image, {.depth_mm = 0}), InvalidInput);
  EXPECT_THROW(height_from_image(image, {.pitch_mm = -1}), InvalidInput);
  EXPECT_THROW(height_from_image(image, {.method = HeightMethod::variational, .light = Vec3{0, 0, -1}}), InvalidInput);
  GreyImage bad = image;
  bad.at(5, 5) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(height_from_image(bad), InvalidInput);
  EXPECT_THROW(height_method("magic"), InvalidInput);
  EXPECT_EQ(height_method("tsai-shah"), HeightMethod::tsai_shah);
  EXPECT_EQ(to_string(HeightMethod::automatic), "auto");
}

}  // namespace
}  // namespace papilla
