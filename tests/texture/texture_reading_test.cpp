// SPDX-License-Identifier: MIT
#include "papilla/texture/texture_reading.hpp"

#include <gtest/gtest.h>

#include "papilla/core/error.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

bool runs(const TextureReading& reading, std::string_view step) { return step_of(reading.plan, step).run; }

TEST(ReadTexture, ALatticeGetsItsGroupAndNoDimension) {
  const TextureReading reading = read_texture(synthesize_grain(GrainKind::spheres8, {192}).picture);
  EXPECT_EQ(reading.kind.kind, TextureKind::strongly_ordered_symmetric);
  EXPECT_TRUE(reading.symmetry.lattice.found);
  EXPECT_TRUE(reading.group);
  EXPECT_FALSE(reading.roughness);
  EXPECT_TRUE(runs(reading, "primitive") && runs(reading, "generating_region") && runs(reading, "exact_tile"));
  EXPECT_FALSE(runs(reading, "fractal_dimension") || runs(reading, "roughness") || runs(reading, "fractal_synthesis"));
}

TEST(ReadTexture, WhatIsDisorderedGetsADimensionAndNoGroup) {
  const TextureReading reading = read_texture(to_grey_image(brownian_surface_exact({193, 0.4, 3}), 8));
  EXPECT_EQ(reading.kind.kind, TextureKind::disordered);
  EXPECT_FALSE(reading.group);
  ASSERT_TRUE(reading.roughness && reading.roughness->power_law());
  EXPECT_NEAR(reading.roughness->estimate->hurst, 0.4, 0.05);
  EXPECT_TRUE(runs(reading, "fractal_dimension") && runs(reading, "fractal_synthesis"));
  EXPECT_FALSE(runs(reading, "primitive") || runs(reading, "generating_region") || runs(reading, "roughness"));
}

TEST(ReadTexture, OfACompositeTheDimensionIsThatOfTheRest) {
  GreyImage image = synthesize_grain(GrainKind::quads8, {256}).picture;
  const GreyImage rough = to_grey_image(brownian_surface_exact({257, 0.3, 5}));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) image.at(x, y) = 0.5F * image.at(x, y) + 0.6F * rough.at(x, y);
  const TextureReading reading = read_texture(image);
  ASSERT_EQ(reading.kind.kind, TextureKind::composite) << reading.kind.strongly_ordered;
  EXPECT_TRUE(reading.group);
  ASSERT_TRUE(reading.roughness && reading.roughness->power_law());
  EXPECT_NEAR(reading.roughness->estimate->hurst, 0.3, 0.1);
  EXPECT_TRUE(runs(reading, "roughness"));
}

TEST(ReadTexture, AFlatPictureNeedsNothing) {
  const TextureReading reading = read_texture(test::make_image(64, 40, [](int, int) { return 0.5; }));
  EXPECT_FALSE(reading.group || reading.roughness);
  EXPECT_FALSE(reading.symmetry.lattice.found);
  for (const PlanStep& step : reading.plan) {
    EXPECT_FALSE(step.run) << step.step;
    EXPECT_EQ(step.reason, "the picture is flat") << step.step;
  }
}

TEST(ReadTexture, RefusesWhatIsNoPicture) { EXPECT_THROW(read_texture({}), InvalidInput); }

TEST(TextureReading, LooksForNothingAfterTheDeadline) {
  ReadingOptions options;
  options.deadline = Deadline(-1);
  const TextureReading reading = read_texture(synthesize_grain(GrainKind::spheres8, {192}).picture, options);
  EXPECT_EQ(reading.stop, StopReason::time_limit);
  EXPECT_FALSE(reading.symmetry.lattice.found);
  EXPECT_FALSE(reading.group);
  EXPECT_FALSE(reading.roughness);
  EXPECT_FALSE(step_of(reading.plan, "generating_region").run);
  EXPECT_THROW(step_of({}, "primitive"), InvalidInput);
}

}  // namespace
}  // namespace papilla
