// SPDX-License-Identifier: MIT
#include "surface_change.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "papilla_test/shapes.hpp"

namespace papilla::detail {
namespace {

/// A sheet, and the same with a triangle 3 mm above its middle: by one more surface came up, by one less it was lost.
TEST(SurfaceChange, LooksForWhatWasLostAndForWhatCameUp) {
  TriangleMesh less;
  const TriangleMesh sheet = papilla::test::plane(30, 20, 12, 8);
  less.positions = sheet.positions, less.triangles = sheet.triangles;
  TriangleMesh more = less;
  const auto first = static_cast<Index>(more.positions.size());
  more.positions.insert(more.positions.end(), {{14, 9, 3}, {16, 9, 3}, {15, 11, 3}});
  more.triangles.push_back({first, first + 1, first + 2});
  const auto change = [](const TriangleMesh& before, const TriangleMesh& after, std::size_t sample_above) {
    std::vector<Index> all(before.triangles.size());
    std::iota(all.begin(), all.end(), Index{0});
    return surface_change(before, all, after, {.reach_mm = 5, .floor_mm = 1e-3, .sample_above = sample_above});
  };
  for (const bool sampled : {false, true}) {
    const std::size_t sample_above = sampled ? 1 : 1000;
    const SurfaceChange came = change(less, more, sample_above), went = change(more, less, sample_above);
    EXPECT_EQ(came.sampled, sampled);
    EXPECT_NEAR(came.lost_mm, 0, 1e-3) << sampled;
    for (const double most : {came.added_mm, went.lost_mm}) {  // Whole, it is a bound over pieces.
      EXPECT_GE(most, 3 - 1e-9) << sampled;
      EXPECT_LE(most, sampled ? 3 + 1e-9 : 3.05) << sampled;
    }
    EXPECT_NEAR(went.added_mm, 0, 1e-3) << sampled;
  }
}

}  // namespace
}  // namespace papilla::detail
