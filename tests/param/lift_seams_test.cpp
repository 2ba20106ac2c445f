// SPDX-License-Identifier: MIT
#include "lift_seams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "drawn_seams.hpp"
#include "lift_map.hpp"
#include "papilla/meshing/coarsen.hpp"
#include "papilla_test/shapes.hpp"
#include "seam_paths.hpp"
#include "straighten_seams.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// A mesh whose seams cost their length.
struct Priced {
  explicit Priced(TriangleMesh of) : mesh(std::move(of)), costs(3 * mesh.triangles.size(), 0), seams(mesh, costs) {
    for (Index h = 0; h < costs.size(); ++h) costs[h] = seams.length(h);
  }
  std::vector<std::uint8_t> borders() const { return test::border_seams(seams); }
  void cut(std::vector<std::uint8_t>& seam, Vec3 a, Vec3 b) const { test::draw_seam(seams, seam, a, b); }
  double length(const std::vector<std::uint8_t>& seam) const {
    double sum = 0;
    for (Index h = 0; h < seam.size(); ++h)
      if (seam[h] && seams.opposite[h] != k_no_triangle) sum += 0.5 * seams.length(h);
    return sum;
  }
  std::size_t tips(const std::vector<std::uint8_t>& seam) const {
    std::size_t count = 0;
    for (const SeamPath& path : seam_paths(seams, seam)) count += path.tip_at_start + path.tip_at_end;
    return count;
  }

  TriangleMesh mesh;
  std::vector<double> costs;
  SeamMesh seams;
};

/// Of each vertex of the coarse mesh, the one of the fine mesh at its place.
std::vector<Index> places(const TriangleMesh& coarse, const TriangleMesh& fine) {
  std::vector<Index> vertices;
  for (const Vec3& p : coarse.positions)
    for (Index v = 0; v < fine.positions.size(); ++v)
      if (norm(fine.positions[v] - p) < 1e-9) vertices.push_back(v);
  EXPECT_EQ(vertices.size(), coarse.positions.size());
  return vertices;
}

TEST(LiftSeams, StraightSeamsStayWhereTheyAre) {
  const Priced coarse(test::plane(40, 12, 4, 2)), fine(test::plane(40, 12, 20, 12));
  const std::vector<Index> vertices = places(coarse.mesh, fine.mesh);
  // Along y a slit, along x a cut from border to border, which meet.
  std::vector<std::uint8_t> seam = coarse.borders();
  coarse.cut(seam, {10, 6, 0}, {10, 12, 0});
  coarse.cut(seam, {0, 6, 0}, {40, 6, 0});
  const std::vector<std::uint8_t> lifted = lift_seams(fine.seams, coarse.seams, vertices, seam);
  std::vector<std::uint8_t> expected = fine.borders();
  fine.cut(expected, {10, 6, 0}, {10, 12, 0});
  fine.cut(expected, {0, 6, 0}, {40, 6, 0});
  EXPECT_EQ(lifted, expected);
  EXPECT_EQ(charts_between(fine.seams, lifted).count, 3u);
}

TEST(LiftSeams, CornersOfOneTriangleAreReachedBesideThem) {
  // Of the fine mesh, no seam can run to the corners at (40, 0) and (0, 12). The coarse one joins them.
  TriangleMesh two;
  two.positions = {{0, 0, 0}, {40, 0, 0}, {40, 12, 0}, {0, 12, 0}};
  two.triangles = {{0, 1, 3}, {1, 2, 3}};
  const Priced coarse(two), fine(test::plane(40, 12, 20, 12));
  std::vector<std::uint8_t> seam = coarse.borders();
  coarse.cut(seam, {40, 0, 0}, {0, 12, 0});
  const std::vector<std::uint8_t> lifted = lift_seams(fine.seams, coarse.seams, places(two, fine.mesh), seam);
  EXPECT_EQ(fine.tips(lifted), 0u);
  EXPECT_EQ(charts_between(fine.seams, lifted).count, 2u);
}

TEST(LiftSeams, NeighboursKeepApart) {
  // Slits from opposite borders that pass each other at one coarse edge's distance.
  const Priced coarse(test::plane(8, 30, 4, 10)), fine(test::plane(8, 30, 12, 40));
  std::vector<std::uint8_t> seam = coarse.borders();
  coarse.cut(seam, {4, 0, 0}, {4, 21, 0});
  coarse.cut(seam, {6, 30, 0}, {6, 9, 0});
  const std::vector<std::uint8_t> lifted = lift_seams(fine.seams, coarse.seams, places(coarse.mesh, fine.mesh), seam);
  EXPECT_EQ(coarse.tips(seam), 2u);
  EXPECT_EQ(fine.tips(lifted), 2u);
  EXPECT_EQ(charts_between(fine.seams, lifted).count, 1u);
  EXPECT_NEAR(fine.length(lifted), 42, 1e-9);
}

TEST(LiftSeams, NeighboursKeepApartWhereOneWayIsCheap) {
  const Priced coarse(test::plane(8, 30, 4, 3));
  Priced fine(test::plane(8, 30, 16, 30));
  for (Index h = 0; h < fine.costs.size(); ++h) {
    const Vec3 a = fine.mesh.positions[fine.seams.from(h)], b = fine.mesh.positions[fine.seams.to(h)];
    if (std::abs(a.x - 4) + std::abs(b.x - 4) < 1e-9) fine.costs[h] *= 0.05;
  }
  std::vector<std::uint8_t> seam = coarse.borders();
  coarse.cut(seam, {4, 0, 0}, {4, 20, 0});
  coarse.cut(seam, {6, 30, 0}, {6, 10, 0});
  const std::vector<std::uint8_t> lifted = lift_seams(fine.seams, coarse.seams, places(coarse.mesh, fine.mesh), seam);
  EXPECT_EQ(fine.tips(lifted), 2u);
  EXPECT_EQ(charts_between(fine.seams, lifted).count, 1u);
}

TEST(LiftSeams, WhatGoesAroundSomethingIsNotStraightened) {
  // Three sides of a rectangle of 2 x 6: the fourth is a third as long. A zigzag beside it is straightened.
  const Priced plate(test::plane(12, 12, 12, 12));
  std::vector<std::uint8_t> around = plate.borders();
  plate.cut(around, {4, 2, 0}, {4, 8, 0});
  plate.cut(around, {4, 8, 0}, {6, 8, 0});
  plate.cut(around, {6, 8, 0}, {6, 2, 0});
  plate.cut(around, {6, 2, 0}, {11, 2, 0});
  plate.cut(around, {4, 2, 0}, {1, 2, 0});
  plate.cut(around, {4, 2, 0}, {4, 1, 0});  // places where seams meet
  plate.cut(around, {6, 2, 0}, {6, 1, 0});
  EXPECT_EQ(straightened(plate.seams, around, 6), around);
  std::vector<std::uint8_t> zigzag = plate.borders(), straight = zigzag;
  plate.cut(zigzag, {0, 6, 0}, {5, 6, 0});
  plate.cut(zigzag, {5, 6, 0}, {5, 7, 0});
  plate.cut(zigzag, {5, 7, 0}, {7, 7, 0});
  plate.cut(zigzag, {7, 7, 0}, {7, 6, 0});
  plate.cut(zigzag, {7, 6, 0}, {12, 6, 0});
  plate.cut(straight, {0, 6, 0}, {12, 6, 0});
  EXPECT_EQ(straightened(plate.seams, zigzag, 6), straight);
}

/// Of triangles in space by two affine maps, on either side of x = 20, the places.
Vec2 affine(Vec3 p, bool right) {
  return right ? Vec2{100 - 2 * p.y, 0.5 * p.x} : Vec2{p.x + 0.3 * p.y, 1.5 * p.y - 0.2 * p.x};
}

TEST(LiftMap, TrianglesGoWhereTheCoarseOnesAre) {
  const Priced coarse(test::plane(40, 12, 4, 2)), fine(test::plane(40, 12, 20, 12));
  const auto is_right = [](const TriangleMesh& mesh, const Triangle& t) {
    double x = 0;
    for (const Index v : t) x += mesh.positions[v].x / 3;
    return x > 20;
  };
  CornerAttribute<Vec2> uv;
  for (const Triangle& t : coarse.mesh.triangles) {
    Triangle& corners = uv.indices.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<Index>(uv.values.size());
      uv.values.push_back(affine(coarse.mesh.positions[t[k]], is_right(coarse.mesh, t)));
    }
  }
  const CornerAttribute<Vec2> lifted = MapLifter(fine.seams, coarse.seams, places(coarse.mesh, fine.mesh)).lift(uv);
  ASSERT_EQ(lifted.indices.size(), fine.mesh.triangles.size());
  for (std::size_t t = 0; t < lifted.indices.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& corners = fine.mesh.triangles[t];
      const Vec2 expected = affine(fine.mesh.positions[corners[k]], is_right(fine.mesh, corners));
      EXPECT_LT(norm(lifted.values[lifted.indices[t][k]] - expected), 1e-9) << t;
    }
}

TEST(LiftMap, TrianglesWithoutAreaLeadNowhere) {
  TriangleMesh flat = test::plane(40, 12, 4, 2);
  for (Vec3& p : flat.positions) p = {p.x, 0, 0};
  const Priced mesh(flat);
  std::vector<Index> all(flat.positions.size());
  std::iota(all.begin(), all.end(), Index{0});
  CornerAttribute<Vec2> uv{{}, flat.triangles};
  for (const Vec3& p : flat.positions) uv.values.push_back({p.x, 7});
  for (const Vec2 p : MapLifter(mesh.seams, mesh.seams, all).lift(uv).values) {
    EXPECT_TRUE(p.x >= 0 && p.x <= 40) << p.x;
    EXPECT_EQ(p.y, 7);
  }
}

TEST(LiftMap, OfTwoSidesThatOfTheTriangleIsTaken) {
  // A sheet folded back onto itself, 0.2 above it: the middle of a triangle lies nearly over the other leaf as well.
  const auto folded = [](TriangleMesh mesh) {
    for (Vec3& p : mesh.positions)
      if (p.x > 20) p = {40 - p.x, p.y, std::min(0.2, 0.2 * (p.x - 20))};
    return mesh;
  };
  const Priced coarse(folded(test::plane(40, 12, 20, 6))), fine(folded(test::plane(40, 12, 80, 18)));
  const std::vector<Index> vertices = places(coarse.mesh, fine.mesh);
  const auto unfolded = [](Vec3 p) { return Vec2{p.z > 0 ? 40 - p.x : p.x, p.y}; };
  CornerAttribute<Vec2> uv{{}, coarse.mesh.triangles};
  for (const Vec3& p : coarse.mesh.positions) uv.values.push_back(unfolded(p));
  const CornerAttribute<Vec2> lifted = MapLifter(fine.seams, coarse.seams, vertices).lift(uv);
  for (std::size_t t = 0; t < lifted.indices.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 at = lifted.values[lifted.indices[t][k]];
      EXPECT_LT(norm(at - unfolded(fine.mesh.positions[fine.mesh.triangles[t][k]])), 0.05) << t;
    }
}

TEST(LiftSeams, WaysOfASphereAreNearlyAsShortAsItsEdgesAllow) {
  const Priced fine(test::uv_sphere(10, 40, 90));
  const CoarseMesh few = coarsen(fine.mesh, 300);
  const Priced coarse(few.mesh);
  // From pole to pole and around nothing: a shortest way over coarse edges is no shorter than half a great circle.
  std::vector<std::uint8_t> seam(3 * coarse.mesh.triangles.size(), 0);
  Index v = 0;
  for (Index i = 1; i < coarse.mesh.positions.size(); ++i)
    if (coarse.mesh.positions[i].z > coarse.mesh.positions[v].z) v = i;
  double length = 0;
  for (bool down = true; down;) {  // the edge that leads down most steeply
    Index best = ~Index{0};
    double steepest = 0;
    for (Index h = 0; h < seam.size(); ++h) {
      const double fall = coarse.mesh.positions[coarse.seams.from(h)].z - coarse.mesh.positions[coarse.seams.to(h)].z;
      if (coarse.seams.from(h) == v && fall > steepest * coarse.seams.length(h))
        steepest = fall / coarse.seams.length(h), best = h;
    }
    down = best != ~Index{0};
    if (!down) break;
    seam[best] = seam[coarse.seams.opposite[best]] = 1;
    length += coarse.seams.length(best);
    v = coarse.seams.to(best);
  }
  const std::vector<std::uint8_t> lifted = lift_seams(fine.seams, coarse.seams, few.vertices, seam);
  EXPECT_EQ(fine.tips(lifted), 2u);
  EXPECT_EQ(charts_between(fine.seams, lifted).count, 1u);
  EXPECT_GT(fine.length(lifted), 0.95 * 10 * 3.14159);
  EXPECT_LT(fine.length(lifted), 1.1 * length);
}

}  // namespace
}  // namespace papilla
