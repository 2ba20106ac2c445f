// SPDX-License-Identifier: MIT
#include "papilla/meshing/simplify.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace papilla::test {
namespace {

/// z = sin(x) sin(y) on n × n cells of [0, 2π]².
TriangleMesh waves(Index n) {
  TriangleMesh mesh;
  const double step = 2 * std::acos(-1.0) / n;
  for (Index j = 0; j <= n; ++j)
    for (Index i = 0; i <= n; ++i)
      mesh.positions.push_back({i * step, j * step, std::sin(i * step) * std::sin(j * step)});
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

TEST(SimplifyLadder, WiderTolerancesLeaveFewerTrianglesWithinThem) {
  const std::array<double, 3> tolerances = {0.003, 0.03, 0.3};
  const TriangleMesh mesh = waves(32);
  const std::vector<SimplifyStep> steps = simplify_ladder(mesh, tolerances);
  ASSERT_EQ(steps.size(), 3u);
  std::size_t before = mesh.triangles.size();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(steps[i].tolerance_mm, tolerances[i]);
    EXPECT_LT(steps[i].triangles, before);
    EXPECT_LE(steps[i].deviation_mm, steps[i].deviation_bound_mm);
    EXPECT_LE(steps[i].deviation_bound_mm, tolerances[i]);
    EXPECT_GT(steps[i].deviation_mm, 0);
    EXPECT_FALSE(steps[i].trace.empty());
    before = steps[i].triangles;
  }
}

}  // namespace
}  // namespace papilla::test
