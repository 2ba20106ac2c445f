// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/symmetry.hpp"
#include "procedural/examples.hpp"

namespace papilla {
namespace {

GreyImage picture_of(const std::string& recipe, int size) {
  const RenderedTexture made = test::rendered(recipe, size, RecipeLibrary::builtin());
  const std::vector<float>& grey = made.values[Channel::main];
  return {size, size, {grey.begin(), grey.end()}, 0.1, 32};
}

// The octaves go below a texel. The finest repeat within the picture, so that it may be refused as periodic.
TEST(Analysis, FindsTheDimensionThatAnFbmWasAskedForOrNone) {
  for (const double h : {0.2, 0.5, 0.8})
    for (int seed = 0; seed < 3; ++seed) {
      const BestDimension best = best_dimension(picture_of(
          "fbm|scale=.25|octaves=10|dynamicoctaves=false|seed=" + std::to_string(seed) + "|h=" + std::to_string(h),
          512));
      if (best.power_law())
        EXPECT_NEAR(best.estimate->dimension, 3 - h, 0.1);
      else
        EXPECT_FALSE(best.reason.empty());
    }
}

TEST(Analysis, FindsTheLatticeOfRegularTypes) {
  struct Regular {
    const char* recipe;
    std::array<Vec2, 2> lattice;  ///< Texels of 256 x 256.
  };
  const Regular all[] = {
      {"brick|brickwidth=.125|brickheight=.0625", {{{32, 0}, {0, 16}}}},
      {"brick|brickwidth=.125|brickheight=.0625|switching=true", {{{16, -16}, {16, 16}}}},
      {"brick|tiling=true|rows=8|columns=6|round=1", {{{256.0 / 6, 0}, {0, 32}}}},
      {"checker|scale=.25", {{{32, -32}, {32, 32}}}},
      {"circle|scale=.125|seamless=true", {{{32, 0}, {0, 32}}}},
      {"block|scale=.25", {{{64, 0}, {0, 64}}}},
      {"star|scale=.2|seamless=true", {{{51.2, 0}, {0, 51.2}}}},
      {"perforated", {{{25.6, 0}, {0, 25.6}}}},
  };
  for (const Regular& regular : all) {
    const Lattice lattice = analyze_symmetry(picture_of(regular.recipe, 256)).lattice;
    ASSERT_TRUE(lattice.found) << regular.recipe;
    // Order and signs are free where both are equally long.
    for (const Vec2 wanted : regular.lattice) {
      double least = 1e300;
      for (const Vec2 found : lattice.vectors_px) least = std::min({least, norm(found - wanted), norm(found + wanted)});
      EXPECT_LT(least, 0.2) << regular.recipe;
    }
  }
}

TEST(Analysis, FindsNoLatticeInNoise) {
  EXPECT_FALSE(analyze_symmetry(picture_of("fbm|h=.3|scale=.2", 256)).lattice.found);
}

}  // namespace
}  // namespace papilla
