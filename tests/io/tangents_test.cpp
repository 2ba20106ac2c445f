// SPDX-License-Identifier: MIT
#include "tangents.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace papilla {
namespace {

Vec3 direction(const std::array<float, 4>& t) { return {double{t[0]}, double{t[1]}, double{t[2]}}; }

TEST(Tangents, FollowUOfAnAffineMap) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int run = 0; run < 100; ++run) {
    // Points p = u a + v b on a plane, with arbitrary a and b: ∂p/∂u is a.
    const Vec3 a{unit(random), unit(random), unit(random)}, b{unit(random), unit(random), unit(random)};
    const bool mirrored = run % 2 == 1;
    std::vector<Vec2> uv = {{0, 0}, {1, 0.2}, {0.3, 1}};
    if (mirrored)
      for (Vec2& t : uv) t.x = -t.x;
    std::vector<Vec3> positions;
    for (const Vec2& t : uv) positions.push_back(t.x * a + t.y * b);
    const Vec3 normal = normalized(cross(positions[1] - positions[0], positions[2] - positions[0]));
    const std::vector<Vec3> normals(3, normal);
    const std::vector<Triangle> triangles = {{0, 1, 2}};
    for (const auto& tangent : vertex_tangents(positions, normals, uv, triangles)) {
      EXPECT_NEAR(norm(direction(tangent) - normalized(a)), 0, 1e-6);
      // cross(normal, tangent) · handedness points to growing v.
      EXPECT_GT(double{tangent[3]} * dot(cross(normal, direction(tangent)), b), 0);
      EXPECT_EQ(tangent[3], mirrored ? -1.0F : 1.0F);
    }
  }
}

/// Around a vertex u runs along x in a quarter and along x + y in another: half way between, in however many triangles
/// the second quarter is cut.
TEST(Tangents, WeighByAngleHoweverTheMeshIsCut) {
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-0.5, 0.5, 0}, {-0.8, 0.2, 0}};
  const std::vector<Vec2> uv = {{0, 0}, {1, 0}, {0, 1}, {-1, 1}, {-0.5, 1}, {-0.8, 1}};
  const std::vector<Vec3> normals(6, {0, 0, 1});
  const std::vector<Triangle> whole = {{0, 1, 2}, {0, 2, 3}}, cut = {{0, 1, 2}, {0, 2, 4}, {0, 4, 5}, {0, 5, 3}};
  const Vec3 expected = normalized(Vec3{1, 0, 0} + normalized(Vec3{1, 1, 0}));
  for (const auto& triangles : {whole, cut})
    EXPECT_NEAR(norm(direction(vertex_tangents(positions, normals, uv, triangles)[0]) - expected), 0, 1e-6)
        << triangles.size();
}

TEST(Tangents, WithoutUsableUvAnyPerpendicularUnitVector) {
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  for (const Vec3 normal : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, normalized(Vec3{1, 1, 1})})
    for (const auto& tangent :
         vertex_tangents(positions, std::vector<Vec3>(3, normal), std::vector<Vec2>(3), triangles)) {
      EXPECT_NEAR(dot(direction(tangent), normal), 0, 1e-6);
      EXPECT_NEAR(norm(direction(tangent)), 1, 1e-6);
    }
}

}  // namespace
}  // namespace papilla
