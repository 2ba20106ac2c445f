// SPDX-License-Identifier: MIT
#include "papilla/texture/light_direction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/spectral_surface.hpp"
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
