// SPDX-License-Identifier: MIT
#include "papilla/texture/light_direction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "papilla/texture/test_relief.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

TEST(LightDirection, AzimuthOfAnIsotropicRelief) {
  const HeightGrid surface = spectral_surface({256, 0.8, 6, 60, 4});
  const HeightMap relief = test::make_relief(256, 256, 1, [&](int x, int y) { return 0.8 * surface.at(x, y); });
  for (int k = 1; k < 8; ++k) {
    const double azimuth = -std::numbers::pi * k / 8;  // From above the picture.
    const Vec3 light = {0.7 * std::cos(azimuth), 0.7 * std::sin(azimuth), 0.7};
    const LightEstimate estimate = estimate_light(render_lambert(relief, light));
    EXPECT_NEAR(std::atan2(estimate.direction.y, estimate.direction.x), azimuth, 0.12) << k;
    EXPECT_NEAR(estimate.coherence, 0.5, 0.12);
    EXPECT_NEAR(norm(estimate.direction), 1, 1e-12);
  }
}

TEST(LightDirection, AzimuthInAnOblongPicture) {
  const HeightGrid surface = spectral_surface({256, 0.8, 6, 60, 4});
  const HeightMap relief = test::make_relief(256, 112, 1, [&](int x, int y) { return 0.8 * surface.at(x, y); });
  for (int k = 1; k < 8; ++k) {
    const double azimuth = -std::numbers::pi * k / 8;
    const LightEstimate estimate =
        estimate_light(render_lambert(relief, {0.7 * std::cos(azimuth), 0.7 * std::sin(azimuth), 0.7}));
    EXPECT_NEAR(std::atan2(estimate.direction.y, estimate.direction.x), azimuth, 0.2) << k;
    EXPECT_NEAR(estimate.coherence, 0.5, 0.15) << k;
  }
}

double off_axis_deg(const LightEstimate& estimate, double azimuth) {
  const double off = std::atan2(estimate.direction.y, estimate.direction.x) - azimuth;
  return std::abs(std::remainder(off, std::numbers::pi)) * 180 / std::numbers::pi;
}

// Their waves run within 20 degrees of one direction: the strongest gradient is up to 55 degrees off.
TEST(LightDirection, AxisByTheBendsOfRibs) {
  const HeightMap relief = test_relief("ribs", {.width = 320, .height = 240, .seed = 5});
  double sum = 0;
  for (const int k : {0, 1, 2, 3, 5}) {  // The fourth runs along the ribs: they hardly shade.
    const double azimuth = std::numbers::pi * k / 6;
    const Vec3 light = {0.8 * std::cos(azimuth), 0.8 * std::sin(azimuth), 0.6};
    const LightEstimate estimate = estimate_light(render_lambert(relief, light));
    sum += off_axis_deg(estimate, azimuth) / 5;
    EXPECT_LT(off_axis_deg(estimate, azimuth), 2 * estimate.uncertainty_deg) << k;
  }
  EXPECT_LT(sum, 12);
}

TEST(LightDirection, StraightRibsSayThatTheyTellNothing) {
  const HeightMap relief = test::make_relief(240, 180, 1, [](int x, int y) { return std::sin(0.3 * x + 0.14 * y); });
  for (const double azimuth : {0.1, 0.9, -0.6}) {
    const Vec3 light = {0.8 * std::cos(azimuth), 0.8 * std::sin(azimuth), 0.6};
    const LightEstimate estimate = estimate_light(render_lambert(relief, light));
    EXPECT_GT(estimate.uncertainty_deg, 20);
    EXPECT_LT(off_axis_deg(estimate, azimuth), 2 * estimate.uncertainty_deg);
  }
}

TEST(LightDirection, FrontalLightHasNoAzimuth) {
  const GrainResult grain = synthesize_grain(GrainKind::spheres6, {128, 40, 0.5, {0, 0, 1}, 1});
  EXPECT_LT(estimate_light(grain.picture).coherence, 0.05);
}

TEST(LightDirection, FlatAndTinyPicturesGiveTheDefault) {
  for (const auto& [w, h] : {std::pair{1, 1}, std::pair{1, 9}, std::pair{20, 20}}) {
    const LightEstimate estimate = estimate_light(test::make_image(w, h, [](int, int) { return 0.4; }));
    EXPECT_EQ(estimate.coherence, 0);
    EXPECT_EQ(estimate.direction, LightEstimate{}.direction);
  }
  EXPECT_THROW(estimate_light(GreyImage{}), InvalidInput);
}

}  // namespace
}  // namespace papilla
