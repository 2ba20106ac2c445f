// SPDX-License-Identifier: MIT
#include "papilla/meshing/visibility.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <limits>

#include "papilla/core/error.hpp"
#include "papilla_test/shapes.hpp"
#include "sample_points.hpp"

namespace papilla {
namespace {

std::array<double, 16> shifted(double x, double y, double z) {
  return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1};
}

const BoxVolume k_far_above{{-40, -40, 190}, {60, 60, 200}};

TEST(MeasureVisibility, TheInnerOfNestedBoxesIsHiddenAndTheOuterIsNot) {
  const TriangleMesh outer = test::cube(20), inner = test::cube(10);
  const std::vector<PlacedMesh> parts{{&outer}, {&inner, shifted(5, 5, 5)}};
  const auto v = measure_visibility(parts, k_far_above);
  EXPECT_EQ(v[1].visible_samples, 0u);
  EXPECT_EQ(v[1].visible_fraction, 0);
  EXPECT_EQ(v[1].low, 0);
  EXPECT_NEAR(v[1].high, 3.84 / 2000, 1e-4);
  // From above a cube shows its lid and, from beside it, its walls, never its bottom: between 1 and 5 of 6 faces.
  EXPECT_GT(v[0].visible_fraction, 1.0 / 6 - 0.01);
  EXPECT_LT(v[0].visible_fraction, 5.0 / 6 + 0.01);
}

TEST(MeasureVisibility, GlassHidesNothing) {
  const TriangleMesh outer = test::cube(20), inner = test::cube(10);
  const std::vector<PlacedMesh> parts{{&outer, shifted(0, 0, 0), false}, {&inner, shifted(5, 5, 5)}};
  EXPECT_GT(measure_visibility(parts, k_far_above)[1].visible_fraction, 0.1);
}

TEST(MeasureVisibility, EyesInsideABoxSeeAllOfItsInside) {
  const TriangleMesh room = test::cube(20);
  const std::vector<PlacedMesh> parts{{&room}};
  const auto v = measure_visibility(parts, SphereVolume{{10, 10, 10}, 1});
  EXPECT_EQ(v[0].visible_samples, v[0].samples);
  EXPECT_EQ(v[0].high, 1);
  EXPECT_GT(v[0].low, 0.99);
}

/// A point eye at height h over a sheet at height g over the ground hides the sheet's central projection.
TEST(MeasureVisibility, TheShadowOfASheetHasItsProjectedArea) {
  const TriangleMesh ground = test::plane(100, 100, 1, 1), sheet = test::plane(10, 10, 1, 1);
  const std::vector<PlacedMesh> parts{{&ground}, {&sheet, shifted(45, 45, 50)}};
  VisibilityOptions options;
  options.samples_per_part = 20'000;
  const auto v = measure_visibility(parts, SphereVolume{{50, 50, 100}, 0}, options);
  const double shadow = 20.0 * 20.0 / (100 * 100);
  EXPECT_NEAR(v[0].visible_fraction, 1 - shadow, 0.003);
  EXPECT_LE(v[0].low, 1 - shadow);
  EXPECT_GE(v[0].high, 1 - shadow);
  EXPECT_EQ(v[1].visible_fraction, 1);
}

TEST(MeasureVisibility, TransformsMoveAndScaleParts) {
  const TriangleMesh ground = test::plane(100, 100, 1, 1), sheet = test::plane(1, 1, 1, 1);
  const std::array<double, 16> grown{200, 0, 0, -50, 0, 200, 0, -50, 0, 0, 1, 50, 0, 0, 0, 1};
  const std::vector<PlacedMesh> parts{{&ground}, {&sheet, grown}};
  EXPECT_EQ(measure_visibility(parts, SphereVolume{{50, 50, 100}, 1})[0].visible_samples, 0u);
}

TEST(MeasureVisibility, CoincidentSheetsDoNotHideEachOther) {
  const TriangleMesh sheet = test::plane(10, 10, 3, 3), other = test::plane(10, 10, 2, 2);
  const std::vector<PlacedMesh> parts{{&sheet}, {&other}};
  for (const PartVisibility& v : measure_visibility(parts, SphereVolume{{5, 5, 30}, 0}))
    EXPECT_EQ(v.visible_fraction, 1);
}

TEST(MeasureVisibility, SameForAnyNumberOfThreads) {
  const TriangleMesh torus = test::torus(10, 3, 40, 20), ball = test::uv_sphere(4, 20, 20);
  const std::vector<PlacedMesh> parts{{&torus}, {&ball}};
  const auto run = [&](std::size_t threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return measure_visibility(parts, SphereVolume{{30, 0, 3}, 2});
  };
  const auto one = run(1), many = run(8);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(one[i].visible_samples, many[i].visible_samples);
    EXPECT_GT(one[i].visible_samples, 0u);
  }
}

TEST(MeasureVisibility, RefusesBadInput) {
  const TriangleMesh cube = test::cube(1);
  const std::vector<PlacedMesh> none{{nullptr}}, good{{&cube}};
  EXPECT_THROW(measure_visibility(none, k_far_above), InvalidInput);
  EXPECT_THROW(measure_visibility(good, BoxVolume{{1, 0, 0}, {0, 1, 1}}), InvalidInput);
  EXPECT_THROW(measure_visibility(good, SphereVolume{{0, 0, 0}, -1}), InvalidInput);
  EXPECT_THROW(measure_reach(good, SphereVolume{{0, 0, NAN}, 1}), InvalidInput);
  const std::vector<PlacedMesh> nowhere{{&cube, shifted(std::numeric_limits<double>::infinity(), 0, 0)}};
  EXPECT_THROW(measure_reach(nowhere, k_far_above), InvalidInput);
  EXPECT_THROW(measure_visibility(good, k_far_above, {0, 1}), InvalidInput);
}

TEST(MeasureReach, CountsTrianglesThatHaveAPointInTheVolume) {
  const TriangleMesh plane = test::plane(10, 10, 1, 1);  // two triangles, split by the diagonal
  const auto inside = [&](const Volume& volume) {
    return measure_reach(std::vector<PlacedMesh>{{&plane}}, volume)[0].triangles_inside;
  };
  EXPECT_EQ(inside(BoxVolume{{4, 4, -1}, {6, 6, 1}}), 2u);  // crosses both, holds no vertex
  EXPECT_EQ(inside(BoxVolume{{4, 4, 0.1}, {6, 6, 1}}), 0u);
  EXPECT_EQ(inside(BoxVolume{{-5, -5, -5}, {20, 20, 5}}), 2u);
  EXPECT_EQ(inside(BoxVolume{{10, 4, 0}, {12, 6, 1}}), 1u);  // touches one along its edge
  EXPECT_EQ(inside(SphereVolume{{12, 5, 0}, 2.001}), 1u);
  EXPECT_EQ(inside(SphereVolume{{12, 5, 0}, 1.999}), 0u);
  EXPECT_EQ(inside(SphereVolume{{5, 5, 3}, 3}), 2u);
}

/// A triangle misses a box that overlaps its own bounding box.
TEST(MeasureReach, IsNotFooledByBoundingBoxes) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
  mesh.triangles = {{0, 1, 2}};
  const std::vector<PlacedMesh> parts{{&mesh}};
  EXPECT_FALSE(measure_reach(parts, BoxVolume{{6, 6, -1}, {9, 9, 1}})[0].in_reach());
  EXPECT_TRUE(measure_reach(parts, BoxVolume{{4, 4, -1}, {9, 9, 1}})[0].in_reach());
}

TEST(MeasureReach, PartsOutsideAreOutside) {
  const TriangleMesh cube = test::cube(1);
  // The last one lies over a corner of the box, its sides askew to all axes.
  const std::vector<PlacedMesh> parts{
      {&cube},
      {&cube, shifted(100, 0, 0)},
      {&cube, shifted(0, 100, 0)},
      {&cube, shifted(0, 0, 100)},
      {&cube, shifted(0, 0, -100)},
      {&cube, {0.6, -0.48, 0.64, 3, 0.8, 0.36, -0.48, 3, 0, 0.8, 0.6, 5.5, 0, 0, 0, 1}}};
  const auto reach = measure_reach(parts, BoxVolume{{-5, -5, -5}, {5, 5, 5}});
  EXPECT_TRUE(reach[0].in_reach());
  EXPECT_EQ(reach[0].triangles_inside, 12u);
  for (std::size_t i = 1; i < parts.size(); ++i) EXPECT_FALSE(reach[i].in_reach()) << i;
  EXPECT_EQ(reach[1].triangles, 12u);
}

TEST(PointIn, EyesAreSpreadEvenlyOverTheirVolume) {
  constexpr int n = 20000;
  const Vec3 low{-1, 2, 5}, size{4, 1, 10};
  const BoxVolume box{low, low + size};
  const SphereVolume ball{{10, 20, 30}, 4};
  Vec3 mean;
  double xy = 0, yz = 0, zx = 0, cubed = 0;
  int near = 0, high = 0;
  for (std::uint64_t i = 0; i < n; ++i) {
    const Vec3 p = detail::point_in(box, i) - low;
    const Vec3 share{p.x / size.x, p.y / size.y, p.z / size.z};
    mean = mean + (1.0 / n) * share;
    xy += (share.x - 0.5) * (share.y - 0.5) / n;
    yz += (share.y - 0.5) * (share.z - 0.5) / n;
    zx += (share.z - 0.5) * (share.x - 0.5) / n;
    const Vec3 q = detail::point_in(ball, i) - ball.centre;
    near += norm(q) < 2;
    high += q.z > 2;
    cubed += std::pow(norm(q) / 4, 3) / n;
  }
  EXPECT_LT(norm(mean - Vec3{0.5, 0.5, 0.5}), 1e-3);
  for (const double product : {xy, yz, zx}) EXPECT_NEAR(product, 0, 4e-3) << "of 1/12 at most";
  EXPECT_NEAR(near, n / 8.0, 0.01 * n) << "half the radius, an eighth of the volume";
  EXPECT_NEAR(high, n * 5 / 32.0, 0.01 * n) << "the cap above half the radius";
  EXPECT_NEAR(cubed, 0.5, 1e-3);
}

}  // namespace
}  // namespace papilla
