// SPDX-License-Identifier: MIT
#include "polygon_triangulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

Vec3 vector_area(const std::vector<Vec3>& p) {
  Vec3 sum;
  for (std::size_t i = 0; i < p.size(); ++i) sum = sum + 0.5 * cross(p[i], p[(i + 1) % p.size()]);
  return sum;
}

/// The triangles of a simple planar polygon fill it once when their signed areas are positive and add up to its area.
void expect_fills(const std::vector<Vec3>& polygon) {
  const Vec3 whole = vector_area(polygon);
  const auto triangles = triangulate_polygon(polygon);
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const double area = dot(vector_area({polygon[a], polygon[b], polygon[c]}), normalized(whole));
    EXPECT_GE(area, -1e-9 * norm(whole));
    sum += area;
  }
  EXPECT_NEAR(sum, norm(whole), 1e-9 * norm(whole));
}

TEST(PolygonTriangulation, ArrowHead) {
  expect_fills({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1.5, 0.5, 0}});
  expect_fills({{1.5, 0.5, 0}, {0, 0, 0}, {2, 0, 0}, {2, 2, 0}});
}

TEST(PolygonTriangulation, ConcaveShapesInAnyPlaneAndDirection) {
  const std::vector<Vec3> comb = {{0, 0, 0}, {7, 0, 0}, {7, 4, 0}, {6, 4, 0}, {6, 1, 0}, {5, 1, 0}, {5, 4, 0},
                                  {4, 4, 0}, {4, 1, 0}, {2, 1, 0}, {2, 4, 0}, {1, 4, 0}, {1, 1, 0}, {0, 1, 0}};
  for (int axis = 0; axis < 6; ++axis) {
    std::vector<Vec3> turned;
    for (const Vec3& p : comb) {
      const Vec3 q = axis % 3 == 0 ? p : axis % 3 == 1 ? Vec3{p.z, p.x, p.y} : Vec3{p.y, p.z, p.x};
      turned.push_back(axis < 3 ? q : -q);
    }
    expect_fills(turned);
    expect_fills({turned.rbegin(), turned.rend()});
  }
}

TEST(PolygonTriangulation, RandomStars) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> radius(0.2, 1);
  for (int n = 4; n < 60; ++n) {
    std::vector<Vec3> star;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n, r = radius(random);
      star.push_back({r * std::cos(angle), r * std::sin(angle), 0.3 * r * std::cos(angle)});
    }
    expect_fills(star);
  }
}

TEST(PolygonTriangulation, CollinearCornersOfAConvexPolygon) {
  expect_fills({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
}

TEST(PolygonTriangulation, AWindingOfTwoTurnsIsNotConvex) {
  std::vector<Vec3> pentagram;
  for (int i = 0; i < 5; ++i) {
    const double angle = 4 * std::numbers::pi * i / 5;
    pentagram.push_back({std::cos(angle), std::sin(angle), 0});
  }
  EXPECT_EQ(triangulate_polygon(pentagram).size(), 3U);
}

TEST(PolygonTriangulation, DegeneratePolygonsStillEnd) {
  EXPECT_EQ(triangulate_polygon(std::vector<Vec3>(10)).size(), 8U);
  EXPECT_EQ(triangulate_polygon(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}).size(), 3U);
}

TEST(PolygonTriangulation, RefusesHugeConcavePolygons) {
  std::vector<Vec3> zigzag;
  for (std::size_t i = 0; i <= k_max_concave_corners; ++i) zigzag.push_back({double(i), double(i % 2), 0});
  EXPECT_THROW(triangulate_polygon(zigzag), InvalidInput);
}

}  // namespace
}  // namespace papilla
