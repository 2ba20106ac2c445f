// SPDX-License-Identifier: MIT
#include "papilla/param/grain_direction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/triplanar.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

TEST(GrainDirection, LongestDirectionOfABar) {
  TriangleMesh mesh = test::cube(1);
  for (Vec3& p : mesh.positions) {
    const double along = 10 * p.x;
    p = {0.6 * along + 3, 0.8 * along - 7, p.y};
  }
  const Vec3 d = longest_direction(mesh);
  EXPECT_NEAR(d.x, 0.6, 1e-9);
  EXPECT_NEAR(d.y, 0.8, 1e-9);
  EXPECT_EQ(longest_direction({}), (Vec3{0, 0, 1}));
}

TEST(GrainDirection, VGrowsAlongItOnAllChartsThatHaveIt) {
  const TriangleMesh mesh = test::cube(4);
  const Flattening f = flatten_triplanar(mesh).flattening;
  const CornerAttribute<Vec2> uv = turn_to_grain(mesh, f, {3, 0, 0});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 n = cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      const Vec2 edge = uv.values[uv.indices[t][l]] - uv.values[uv.indices[t][k]];
      const Vec3 in_space = mesh.corner(t, static_cast<int>(l)) - mesh.corner(t, static_cast<int>(k));
      if (std::abs(n.x) < 1e-9) {
        EXPECT_NEAR(edge.y, in_space.x, 1e-12);
      } else {  // across the direction: as before
        EXPECT_EQ(edge, f.uv.values[f.uv.indices[t][l]] - f.uv.values[f.uv.indices[t][k]]);
      }
    }
  }
  const DistortionReport d = measure_distortion(mesh, uv);
  EXPECT_EQ(d.mirrored_charts, 0u);
  EXPECT_NEAR(d.symmetric_dirichlet.max, 4, 1e-9);
}

TEST(GrainDirection, BadInputIsNamed) {
  const TriangleMesh mesh = test::cube(4);
  const Flattening f = flatten_triplanar(mesh).flattening;
  EXPECT_THROW(turn_to_grain(mesh, f, {}), InvalidInput);
  EXPECT_THROW(turn_to_grain(mesh, f, {std::numeric_limits<double>::quiet_NaN(), 0, 1}), InvalidInput);
  EXPECT_THROW(turn_to_grain(test::plane(1, 1, 1, 1), f, {1, 0, 0}), InvalidInput);
}

}  // namespace
}  // namespace papilla
