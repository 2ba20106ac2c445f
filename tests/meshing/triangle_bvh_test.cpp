// SPDX-License-Identifier: MIT
#include "triangle_bvh.hpp"

#include <gtest/gtest.h>

#include <array>

namespace papilla::detail {
namespace {

/// An oblique triangle of unequal sides, from each of its corners.
std::array<std::array<Vec3, 3>, 3> turned_triangles() {
  const Vec3 a{1, 2, 3}, b{5, 3, 3}, c{2, 7, 5};
  return {{{a, b, c}, {b, c, a}, {c, a, b}}};
}

TEST(ClosestOnTriangle, IsTheFootOnItsPlaneOnAnEdgeOrACorner) {
  for (const auto& [a, b, c] : turned_triangles()) {
    const TriangleFrame frame(a, b, c);
    const Vec3 normal = normalized(cross(b - a, c - a)), beside = normalized(cross(c - b, normal));
    const auto expect_closest = [&](const Vec3& p, const Vec3& closest) {
      EXPECT_LT(norm(closest_on_triangle(p, frame) - closest), 1e-12);
    };
    for (const double share : {0.1, 0.35, 0.8}) {
      const Vec3 on_edge = b + share * (c - b);
      expect_closest(on_edge + 3 * beside - 2 * normal, on_edge);
      const Vec3 within = a + 0.9 * (on_edge - a);
      expect_closest(within + 4 * normal, within);
    }
    expect_closest(b + (b - a) + (b - c) + normal, b);
  }
}

TEST(CutAt, IsWithinAllThreeEdges) {
  for (const auto& [a, b, c] : turned_triangles()) {
    const TriangleFrame frame(a, b, c);
    const Vec3 along = b - a + 2 * cross(b - a, c - a);
    for (const double share : {0.1, 0.35, 0.8}) {
      const Vec3 on_edge = b + share * (c - b);
      const auto cut_of = [&](const Vec3& p) { return cut_at(p - 0.25 * along, along, frame); };
      EXPECT_NEAR(cut_of(on_edge + 0.01 * (a - on_edge)), 0.25, 1e-12);
      EXPECT_EQ(cut_of(on_edge - 0.01 * (a - on_edge)), 0);
    }
  }
}

}  // namespace
}  // namespace papilla::detail
