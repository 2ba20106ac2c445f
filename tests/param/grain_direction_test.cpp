// SPDX-License-Identifier: MIT
#include "papilla/param/grain_direction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/param/lscm.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/triplanar.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

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

/// The second moments of a parallelogram are (a aᵀ + b bᵀ)/12 of its area, however it is cut.
TEST(GrainDirection, LongestDirectionOfAParallelogramOfTwoTriangles) {
  const Vec3 a{4, 1, -2}, b{1, 3, 1};
  const double p = dot(a, a), q = dot(a, b), r = dot(b, b);
  // The largest eigenvector of their Gram matrix, as a combination of a and b.
  const double largest = 0.5 * (p + r) + std::hypot(0.5 * (p - r), q);
  Vec3 expected = normalized(q * a + (largest - p) * b);
  for (const bool other : {false, true}) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, a, b, a + b};
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
    if (other) mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
    const Vec3 found = longest_direction(mesh);
    EXPECT_NEAR(std::abs(dot(found, expected)), 1, 1e-9) << other;
  }
}

/// An oblique triangle, flattened without distortion and turned at random.
TEST(GrainDirection, IsExactOnTrianglesWithoutARightAngle) {
  TriangleMesh mesh;
  mesh.positions = {{1, 2, 3}, {5, 1, 4}, {2, 7, 0}};
  mesh.triangles = {{0, 1, 2}};
  const Vec3 p = mesh.positions[1] - mesh.positions[0], q = mesh.positions[2] - mesh.positions[0];
  const Vec3 along = normalized(p), across = normalized(cross(cross(p, q), p));
  Flattening f;
  f.charts = {{0}, 1};
  f.uv.indices = {{0, 1, 2}};
  for (const Vec3 corner : mesh.positions) {
    const double x = dot(corner - mesh.positions[0], along), y = dot(corner - mesh.positions[0], across);
    f.uv.values.push_back({0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y});
  }
  const Vec3 wanted{0.2, -1, 0.7};
  const Vec3 normal = normalized(cross(p, q)), v = normalized(wanted - dot(wanted, normal) * normal);
  const CornerAttribute<Vec2> uv = turn_to_grain(mesh, f, wanted);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 edge = mesh.corner(0, static_cast<int>((k + 1) % 3)) - mesh.corner(0, static_cast<int>(k));
    const Vec2 turned = uv.values[uv.indices[0][(k + 1) % 3]] - uv.values[uv.indices[0][k]];
    EXPECT_NEAR(turned.y, dot(edge, v), 1e-12);
    EXPECT_NEAR(turned.x, dot(edge, cross(v, normal)), 1e-12);
  }
}

TEST(GrainDirection, VGrowsAlongItOnAllChartsThatHaveIt) {
  const TriangleMesh mesh = test::cube(4);
  const Flattening f = flatten_triplanar(mesh).flattening;
  const CornerAttribute<Vec2> uv = turn_to_grain(mesh, f, Vec3{3, 0, 0});
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

TEST(EdgeLoop, RimOfACylinderIsClosed) {
  const TriangleMesh mesh = test::cylinder(10, 30, 64, 12);  // open at both ends
  const EdgeLoop rim = edge_loop_near(mesh, {20, 0, 100});
  EXPECT_TRUE(rim.is_closed);
  ASSERT_EQ(rim.points.size(), 64u);
  double length = 0;
  for (std::size_t i = 0; i < rim.points.size(); ++i) {
    EXPECT_NEAR(rim.points[i].z, rim.points[0].z, 1e-9);
    length += norm(rim.points[(i + 1) % 64] - rim.points[i]);
  }
  EXPECT_NEAR(length, 2 * 64 * 10 * std::sin(std::numbers::pi / 64), 1e-9);
  EXPECT_NEAR(std::abs(direction_near(rim, {50, 0, 0}).y), 1, 0.06);
}

TEST(EdgeLoop, EdgeOfABoxEndsAtItsCorners) {
  const TriangleMesh mesh = test::cube(4);
  const Bounds3 bounds = bounds_of(mesh);
  const EdgeLoop edge = edge_loop_near(mesh, {bounds.high.x + 1, bounds.middle().y, bounds.high.z + 1});
  EXPECT_FALSE(edge.is_closed);
  ASSERT_EQ(edge.points.size(), 2u);
  EXPECT_EQ(edge.points[0], (Vec3{bounds.high.x, bounds.low.y, bounds.high.z}));
  EXPECT_EQ(edge.points[1], bounds.high);
  // Those along z and x run up and to the right, too; each is picked at its middle.
  for (const Vec3 along : {Vec3{0, 0, 1}, Vec3{1, 0, 0}})
    for (const Vec3 corner : {bounds.low, bounds.high}) {
      const Vec3 low = corner - dot(corner - bounds.low, along) * along,
                 high = corner + dot(bounds.high - corner, along) * along;
      const EdgeLoop other = edge_loop_near(mesh, 0.5 * (low + high));
      ASSERT_EQ(other.points.size(), 2u);
      EXPECT_EQ(other.points[0], low);
      EXPECT_EQ(other.points[1], high);
    }
  EdgeLoopOptions around;
  around.most_turn_deg = 91;
  EXPECT_TRUE(edge_loop_near(mesh, bounds.high, around).is_closed);
  EXPECT_THROW(edge_loop_near(test::uv_sphere(10, 32, 64), {0, 0, 0}), InvalidInput);
  EXPECT_THROW(edge_loop_near(mesh, {std::nan(""), 0, 0}), InvalidInput);
}

/// However the file numbers the corners: those of the mirrored box run the other way.
TEST(EdgeLoop, EveryEdgeOfABoxRunsToWhereItsCoordinateGrows) {
  for (const double sign : {1.0, -1.0}) {
    TriangleMesh mesh = test::cube(4);
    for (Vec3& p : mesh.positions) p = {sign * 3 * p.x, sign * 2 * p.y, sign * p.z};
    if (sign < 0)
      for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    const Bounds3 bounds = bounds_of(mesh);
    const Vec3 size = bounds.high - bounds.low;
    for (const Vec3 along : {Vec3{size.x, 0, 0}, Vec3{0, size.y, 0}, Vec3{0, 0, size.z}})
      for (const int corner : {0, 1, 2, 3}) {
        const Vec3 first = along.x > 0 ? Vec3{0, size.y, 0} : Vec3{size.x, 0, 0};
        const Vec3 second = along.z > 0 ? Vec3{0, size.y, 0} : Vec3{0, 0, size.z};
        const Vec3 low = bounds.low + (corner & 1) * first + (corner >> 1) * second;
        const EdgeLoop edge = edge_loop_near(mesh, low + 0.5 * along);
        ASSERT_EQ(edge.points.size(), 2u);
        EXPECT_LT(norm(edge.points[0] - low), 1e-12);
        EXPECT_LT(norm(edge.points[1] - low - along), 1e-12);
      }
  }
}

TEST(GrainDirection, FollowsAnEdgeLoop) {
  // The wall of a cylinder, unrolled: v runs along the rim, not up.
  const TriangleMesh mesh = test::grid_mesh(64, 30, test::open_cylinder);
  const ChartSet chart{std::vector<std::uint32_t>(mesh.triangles.size(), 0), 1};
  const Flattening f = flatten_lscm(mesh, chart);
  const EdgeLoop rim = edge_loop_near(mesh, mesh.positions[32]);
  const CornerAttribute<Vec2> uv = turn_to_grain(mesh, f, rim);
  double along = 0, across = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int next = static_cast<int>((k + 1) % 3);
      const Vec3 e = mesh.corner(t, next) - mesh.corner(t, static_cast<int>(k));
      const Vec3 d = direction_near(rim, mesh.corner(t, 0));
      const Vec2 m = uv.values[uv.indices[t][(k + 1) % 3]] - uv.values[uv.indices[t][k]];
      if (std::abs(dot(normalized(e), d)) < 0.9) continue;
      along += dot(e, d) * m.y, across += std::abs(m.x);
    }
  EXPECT_GT(along, 0);
  EXPECT_LT(across, 1e-3 * std::sqrt(along * static_cast<double>(mesh.triangles.size())));
  EXPECT_THROW(turn_to_grain(mesh, f, EdgeLoop{}), InvalidInput);
}

TEST(GrainDirection, BadInputIsNamed) {
  const TriangleMesh mesh = test::cube(4);
  const Flattening f = flatten_triplanar(mesh).flattening;
  EXPECT_THROW(turn_to_grain(mesh, f, Vec3{}), InvalidInput);
  EXPECT_THROW(turn_to_grain(mesh, f, Vec3{std::numeric_limits<double>::quiet_NaN(), 0, 1}), InvalidInput);
  EXPECT_THROW(turn_to_grain(test::plane(1, 1, 1, 1), f, Vec3{1, 0, 0}), InvalidInput);
}

}  // namespace
}  // namespace papilla
