// SPDX-License-Identifier: MIT
#include "papilla/texture/test_relief.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "papilla/core/error.hpp"
#include "slopes.hpp"

namespace papilla {
namespace {

TEST(TestRelief, EveryOneHasItsSlopeAndDependsOnTheSeed) {
  const auto names = test_relief_names();
  EXPECT_GE(names.size(), 12U);
  for (const std::string_view name : names) {
    TestReliefOptions options{160, 120, 0.2, 0.25, 4};
    const HeightMap relief = test_relief(name, options);
    ASSERT_EQ(relief.mm.size(), 160U * 120U) << name;
    EXPECT_EQ(*std::min_element(relief.mm.begin(), relief.mm.end()), 0) << name;
    double squares = 0;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x) {
        const Vec2 g = texture_detail::slope(relief, x, y);
        squares += dot(g, g);
      }
    EXPECT_NEAR(std::sqrt(squares / (160 * 120)), 0.25, 1e-4) << name;
    EXPECT_EQ(relief.mm, test_relief(name, options).mm) << name;
    options.seed = 5;
    const bool regular = name == "spheres" || name == "quads" || name == "ovals" || name == "sine";
    EXPECT_EQ(relief.mm == test_relief(name, options).mm, regular) << name;
  }
}

TEST(TestRelief, RefusesBadOptions) {
  EXPECT_THROW(test_relief("velvet"), InvalidInput);
  EXPECT_THROW(test_relief("weave", {.width = 32}), InvalidInput);
  EXPECT_THROW(test_relief("weave", {.pitch_mm = 0}), InvalidInput);
  EXPECT_THROW(test_relief("weave", {.rms_slope = -1}), InvalidInput);
}

}  // namespace
}  // namespace papilla
