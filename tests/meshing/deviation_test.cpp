// SPDX-License-Identifier: MIT
#include "papilla/meshing/deviation.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

TriangleMesh moved(TriangleMesh mesh, Vec3 by) {
  for (Vec3& p : mesh.positions) p = p + by;
  return mesh;
}

TriangleMesh random_soup(std::mt19937& random, std::size_t triangles, double size) {
  std::uniform_real_distribution<double> place(0, 1), offset(-size, size);
  TriangleMesh mesh;
  for (Index t = 0; t < triangles; ++t) {
    const Vec3 centre{place(random), place(random), place(random)};
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(centre + Vec3{offset(random), offset(random), offset(random)});
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

/// Independent of the library's: minimise over the triangle by projection and, outside, over its edges.
double distance_to_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  double best = INFINITY;
  const Vec3 n = normalized(cross(b - a, c - a));
  const Vec3 q = p - dot(p - a, n) * n;
  const auto left_of = [&](Vec3 u, Vec3 v) { return dot(cross(v - u, q - u), n) >= 0; };
  if (left_of(a, b) && left_of(b, c) && left_of(c, a)) best = norm(p - q);
  for (auto [u, v] : {std::pair{a, b}, {b, c}, {c, a}}) {
    const double t = std::clamp(dot(p - u, v - u) / dot(v - u, v - u), 0.0, 1.0);
    best = std::min(best, norm(p - (u + t * (v - u))));
  }
  return best;
}

double brute_distance(Vec3 p, const TriangleMesh& to) {
  double best = INFINITY;
  for (std::size_t t = 0; t < to.triangles.size(); ++t)
    best = std::min(best, distance_to_triangle(p, to.corner(t, 0), to.corner(t, 1), to.corner(t, 2)));
  return best;
}

TEST(SurfaceDeviation, ParallelPlanesOfDifferentMeshesAreTheirOffsetApart) {
  const TriangleMesh fine = test::plane(10, 7, 40, 30);
  const TriangleMesh coarse = moved(test::plane(10, 7, 1, 1), {0, 0, 0.25});
  const DeviationResult d = surface_deviation(fine, coarse);
  for (const OneSidedDeviation& side : {d.from_to, d.to_from}) {
    EXPECT_NEAR(side.value, 0.25, 1e-14);
    EXPECT_NEAR(side.bound, 0.25, 1e-13);
    EXPECT_NEAR(side.mean, 0.25, 1e-12);
    EXPECT_NEAR(side.rms, 0.25, 1e-12);
    EXPECT_EQ(side.unsettled, 0u);
  }
}

TEST(SurfaceDeviation, CoplanarMeshesAreZeroApartToRounding) {
  const DeviationResult d = surface_deviation(test::plane(10, 7, 1, 1), test::plane(10, 7, 200, 300));
  EXPECT_LE(d.bound(), 1e-12);
  EXPECT_EQ(d.from_to.unsettled, 0u);
}

TEST(SurfaceDeviation, OneSideSeesWhatTheOtherDoesNot) {
  TriangleMesh two = test::plane(1, 1, 2, 2);
  const TriangleMesh one = test::plane(1, 1, 2, 2);
  const TriangleMesh far = moved(one, {0, 0, 3});
  for (Triangle t : far.triangles) {
    for (Index& v : t) v += static_cast<Index>(two.positions.size());
    two.triangles.push_back(t);
  }
  two.positions.insert(two.positions.end(), far.positions.begin(), far.positions.end());
  const DeviationResult d = surface_deviation(one, two);
  EXPECT_LE(d.from_to.bound, 1e-15);
  EXPECT_NEAR(d.to_from.value, 3, 1e-12);
  EXPECT_NEAR(d.to_from.at.z, 3, 1e-12);
  EXPECT_NEAR(d.to_from.nearest.z, 0, 1e-12);
  EXPECT_NEAR(d.to_from.mean, 1.5, 1e-9);
  EXPECT_NEAR(d.to_from.rms, 3 / std::numbers::sqrt2, 1e-9);
  DeviationOptions options;
  options.two_sided = false;
  EXPECT_EQ(surface_deviation(one, two, options).to_from.value, 0);
}

/// A regular n-gon prism of circumradius r and one of 64 n sides: the coarse facets' middles lie r (1 - cos(pi / n))
/// inside the circle through the fine mesh's corners.
TEST(SurfaceDeviation, CylinderAgainstAFineOneIsItsSagitta) {
  const double r = 5;
  for (const Index n : {6u, 12u, 25u}) {
    const double sagitta = r * (1 - std::cos(std::numbers::pi / n));
    const DeviationResult d = surface_deviation(test::cylinder(r, 2, n, 1), test::cylinder(r, 2, 64 * n, 1));
    EXPECT_LE(d.value(), sagitta * (1 + 1e-12));
    EXPECT_GE(d.bound(), sagitta * (1 - 1e-12));
    EXPECT_LE(d.bound(), sagitta * 1.02);
    EXPECT_GE(d.value(), sagitta * 0.98);
  }
}

/// Each triangle's circumcentre is the facet's deepest point: r minus the facet's distance from the origin.
TEST(SurfaceDeviation, CoarseSphereLiesInsideAFineOneByTheDepthOfItsDeepestFacet) {
  const double r = 10;
  const TriangleMesh coarse = test::uv_sphere(r, 8, 12), fine = test::uv_sphere(r, 200, 300);
  double deepest = 0;
  for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
    const Vec3 n =
        normalized(cross(coarse.corner(t, 1) - coarse.corner(t, 0), coarse.corner(t, 2) - coarse.corner(t, 0)));
    deepest = std::max(deepest, r - std::abs(dot(n, coarse.corner(t, 0))));
  }
  const double fine_sagitta = r * (1 - std::cos(std::numbers::pi / 200)) * 2;
  const DeviationResult d = surface_deviation(coarse, fine);
  EXPECT_NEAR(d.value(), deepest, 0.01 * deepest + fine_sagitta);
  EXPECT_LE(d.bound() - d.value(), 0.01 * d.value() + 1e-9);
  EXPECT_GE(d.bound(), deepest - fine_sagitta);
}

TEST(SurfaceDeviation, BoundIsNeverBelowAnyPointOfRandomSoups) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (unsigned round = 0; round < 30; ++round) {
    const TriangleMesh from = random_soup(random, 1 + round % 7, 0.4), to = random_soup(random, 1 + round, 0.3);
    DeviationOptions options;
    options.relative_tolerance = round % 2 ? 0.001 : 0.1;
    const DeviationResult d = surface_deviation(from, to, options);
    EXPECT_EQ(d.from_to.unsettled, 0u);
    EXPECT_LE(d.from_to.value, d.from_to.bound);
    EXPECT_LE(d.from_to.bound, d.from_to.value * (1 + options.relative_tolerance) + 1e-5);
    EXPECT_NEAR(d.from_to.value, brute_distance(d.from_to.at, to), 1e-12);
    EXPECT_NEAR(d.from_to.value, norm(d.from_to.at - d.from_to.nearest), 1e-12);
    double seen = 0;
    constexpr int k_samples = 300;
    for (std::size_t t = 0; t < from.triangles.size(); ++t)
      for (int i = 0; i < k_samples; ++i) {
        double u = unit(random), v = unit(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Vec3 a = from.corner(t, 0);
        seen = std::max(seen, brute_distance(a + u * (from.corner(t, 1) - a) + v * (from.corner(t, 2) - a), to));
      }
    EXPECT_LE(seen, d.from_to.bound + 1e-12) << round;
    EXPECT_GE(d.from_to.value, 0.9 * seen);
  }
}

TEST(SurfaceDeviation, NeedlesAndPointsAreMeasuredLikeWhatTheyCover) {
  TriangleMesh needle;
  needle.positions = {{0, 0, 0}, {10, 0, 0}, {5, 1e-13, 0}, {2, 0, 4}};
  needle.triangles = {{0, 1, 2}, {3, 3, 3}};
  const DeviationResult d = surface_deviation(needle, test::plane(10, 1, 3, 1));
  EXPECT_NEAR(d.from_to.value, 4, 1e-12);
  EXPECT_NEAR(d.to_from.value, 1, 1e-9);
  EXPECT_LE(d.to_from.bound, 1.011);
}

TEST(SurfaceDeviation, ListsTheTrianglesAboveALimit) {
  TriangleMesh bent = test::plane(10, 1, 10, 1);
  for (Vec3& p : bent.positions)
    if (p.x > 9.5) p.z = 1;
  DeviationOptions options;
  options.list_above_mm = 0.5;
  const DeviationResult d = surface_deviation(bent, test::plane(10, 1, 1, 1), options);
  ASSERT_EQ(d.from_to.above.size(), 2u);
  for (const ExceedingTriangle& above : d.from_to.above) {
    double top = 0;
    EXPECT_GT(above.value, 0.5);
    EXPECT_NEAR(above.at.z, above.value, 1e-12);
    for (int k = 0; k < 3; ++k) top = std::max(top, bent.corner(above.triangle, k).z);
    EXPECT_EQ(top, 1);
  }
}

TEST(SurfaceDeviation, SettledBelowStillBounds) {
  DeviationOptions options;
  options.settled_below_mm = 1;
  const DeviationResult d = surface_deviation(test::uv_sphere(10, 8, 12), test::uv_sphere(10, 80, 120), options);
  const DeviationResult exact = surface_deviation(test::uv_sphere(10, 8, 12), test::uv_sphere(10, 80, 120));
  EXPECT_LE(d.value(), exact.bound());
  EXPECT_GE(d.bound(), exact.value());
}

TEST(SurfaceDeviation, TellsWhetherItIsWithinATolerance) {
  const TriangleMesh fine = test::torus(10, 3, 90, 40);
  for (const Index segments : {17, 31, 45}) {
    const TriangleMesh coarse = test::torus(10, 3, segments, 17);
    DeviationOptions settled;
    settled.relative_tolerance = 1e-6;
    const double exact = surface_deviation(fine, coarse, settled).bound();
    DeviationOptions options;  // 1 % is what is allowed to a maximum beyond the tolerance, not to one below it.
    options.settled_below_mm = 1.0001 * exact;
    EXPECT_LE(surface_deviation(fine, coarse, options).bound(), options.settled_below_mm) << segments;
    options.settled_below_mm = 0.9999 * exact;
    EXPECT_GT(surface_deviation(fine, coarse, options).bound(), options.settled_below_mm) << segments;
  }
}

TEST(SurfaceDeviation, SameForAnyNumberOfThreads) {
  const TriangleMesh a = test::torus(10, 3, 90, 40), b = test::torus(10, 3, 31, 17);
  const auto run = [&](std::size_t threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return surface_deviation(a, b);
  };
  const DeviationResult one = run(1), many = run(8);
  EXPECT_EQ(one.from_to.value, many.from_to.value);
  EXPECT_EQ(one.from_to.bound, many.from_to.bound);
  EXPECT_EQ(one.from_to.mean, many.from_to.mean);
  EXPECT_EQ(one.to_from.bound, many.to_from.bound);
  EXPECT_EQ(one.to_from.at, many.to_from.at);
}

TEST(SurfaceDeviation, RefusesWhatItCannotMeasure) {
  const TriangleMesh plane = test::plane(1, 1, 1, 1);
  EXPECT_THROW(surface_deviation(plane, TriangleMesh{}), InvalidInput);
  TriangleMesh broken = plane;
  broken.triangles[1][2] = 99;
  EXPECT_THROW(surface_deviation(plane, broken), InvalidInput);
  broken = plane;
  broken.positions[0].y = NAN;
  EXPECT_THROW(surface_deviation(broken, plane), InvalidInput);
  DeviationOptions options;
  options.relative_tolerance = NAN;
  EXPECT_THROW(surface_deviation(plane, plane, options), InvalidInput);
  EXPECT_EQ(surface_deviation(TriangleMesh{}, TriangleMesh{}).bound(), 0);
}

/// Over a long gap the distance is that to its nearer side, the same all along its middle.
TEST(SurfaceDeviation, GapsLongAndNarrowAreSettled) {
  for (const double gap : {1e-2, 1e-5, 1e-7})
    for (const double tilt : {0.0, 1e-6}) {
      TriangleMesh sheet, sides;
      sheet.positions = {{0, 0, 0}, {1000, 0, 0}, {1000, 100, 0}, {0, 100, 0}};
      sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
      sides.positions = {{0, 0, 0},           {1000, 0, tilt},     {1000, 50, 0},  {0, 50, 0},
                         {0, 50 + gap, tilt}, {1000, 50 + gap, 0}, {1000, 100, 0}, {0, 100, tilt}};
      sides.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
      DeviationOptions options;
      options.two_sided = false;
      options.pieces_per_triangle = 500;
      options.absolute_tolerance_mm = 0;
      const OneSidedDeviation found = surface_deviation(sheet, sides, options).from_to;
      EXPECT_EQ(found.unsettled, 0u) << gap << ' ' << tilt;
      EXPECT_GE(found.value, 0.98 * gap / 2);
      EXPECT_LE(found.bound, 1.02 * std::max(gap / 2, tilt) + tilt);
    }
}

}  // namespace
}  // namespace papilla
