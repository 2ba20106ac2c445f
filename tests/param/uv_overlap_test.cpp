// SPDX-License-Identifier: MIT
#include "uv_overlap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace papilla::param_detail {
namespace {

/// Two triangles that are the unit square at a corner.
std::vector<UvTriangle> squares(const std::vector<Vec2>& at, std::uint32_t other_group = 0) {
  std::vector<UvTriangle> triangles;
  for (const Vec2 p : at) {
    const Vec2 right = p + Vec2{1, 0}, top = p + Vec2{0, 1}, far = p + Vec2{1, 1};
    const std::uint32_t group = triangles.empty() ? 0 : other_group;
    triangles.push_back({{p, right, far}, group});
    triangles.push_back({{p, far, top}, group});
  }
  return triangles;
}

TEST(UvOverlap, SquaresShiftedByAQuarterCoverThreeFifthsTwice) {
  const UvOverlap overlap = find_uv_overlap(squares({{0, 0}, {0.25, 0}}), 1024);
  EXPECT_NEAR(overlap.fraction, 0.75 / 1.25, 1e-3);
  EXPECT_EQ(std::count(overlap.overlaps.begin(), overlap.overlaps.end(), 1), 4);
}

TEST(UvOverlap, SquaresShiftedByAQuarterBothWays) {
  const double twice = 0.75 * 0.75;
  EXPECT_NEAR(find_uv_overlap(squares({{0, 0}, {0.25, 0.25}}), 1024).fraction, twice / (2 - twice), 1e-3);
}

/// Two parts that lie over each other, and of which each overlaps itself.
TEST(UvOverlap, EveryGroupHasItsOwnOverlap) {
  std::vector<UvTriangle> triangles = squares({{0, 0}, {0.25, 0}});
  for (UvTriangle t : squares({{0.1, 0}, {0.35, 0}})) {
    t.group = 1;
    triangles.push_back(t);
  }
  EXPECT_NEAR(find_uv_overlap(triangles, 1024).fraction, 0.75 / 1.25, 1e-3);
}

TEST(UvOverlap, NeighboursAndOtherGroupsDoNotOverlap) {
  EXPECT_EQ(find_uv_overlap(squares({{0, 0}, {1, 0}}), 1024).fraction, 0);
  EXPECT_EQ(find_uv_overlap(squares({{0, 0}, {0.25, 0}}, 1), 1024).fraction, 0);
  EXPECT_EQ(find_uv_overlap({}, 1024).fraction, 0);
}

}  // namespace
}  // namespace papilla::param_detail
