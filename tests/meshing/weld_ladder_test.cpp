// SPDX-License-Identifier: MIT
#include "papilla/meshing/weld.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "papilla/core/error.hpp"

namespace papilla::test {
namespace {

/// Two triangles of a square whose diagonals lie `gap` apart.
TriangleMesh cracked_square(double gap) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {gap, 0, 0}, {10, 10 + gap, 0}, {0, 10, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  return mesh;
}

TEST(WeldLadder, CracksCloseOnceTheToleranceReachesThem) {
  const std::array<double, 3> tolerances = {0, 1e-5, 1e-3};
  const std::vector<WeldStep> steps = weld_ladder(cracked_square(1e-4), tolerances);
  ASSERT_EQ(steps.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(steps[i].tolerance_mm, tolerances[i]);
    EXPECT_EQ(steps[i].boundary_edges, i < 2 ? 6u : 4u);
    EXPECT_EQ(steps[i].nonmanifold_edges, 0u);
    EXPECT_EQ(steps[i].triangles, 2u);
    EXPECT_GE(steps[i].seconds, 0);
    EXPECT_LE(steps[i].max_deviation_mm, tolerances[i]);
  }
  EXPECT_GT(steps[2].max_deviation_mm, 0.4e-4);
}

TEST(WeldLadder, RefusesTolerancesThatAreNone) {
  for (const double wrong : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(weld_ladder(cracked_square(1), std::array{wrong}), InvalidInput);
}

}  // namespace
}  // namespace papilla::test
