// SPDX-License-Identifier: MIT
#include "papilla/meshing/simplify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <span>

#include "papilla/core/error.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

SimplifyOptions within(double tolerance_mm) {
  SimplifyOptions options;
  options.tolerance_mm = tolerance_mm;
  return options;
}

void append(TriangleMesh& mesh, const TriangleMesh& other, Vec3 offset) {
  const auto first = static_cast<Index>(mesh.positions.size());
  for (const Vec3& p : other.positions) mesh.positions.push_back(p + offset);
  for (Triangle t : other.triangles) {
    for (Index& v : t) v += first;
    mesh.triangles.push_back(t);
  }
}

/// Six faces of n x n squares each, joined only by equal positions.
TriangleMesh subdivided_cube(double edge, Index n) {
  TriangleMesh mesh;
  const auto turn = [](Vec3 p, int k) {
    for (int i = 0; i < k; ++i) p = {p.z, p.x, p.y};
    return p;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const bool top : {false, true}) {
      TriangleMesh side = test::plane(edge, edge, n, n);
      for (Vec3& p : side.positions) p = turn({p.x, p.y, top ? edge : 0}, axis);
      if (!top)
        for (Triangle& t : side.triangles) std::swap(t[1], t[2]);
      side.uv = {};
      append(mesh, side, {0, 0, 0});
    }
  return mesh;
}

/// Every triangle with its own three positions, as an STL file has them.
TriangleMesh as_soup(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto first = static_cast<Index>(soup.positions.size());
    for (int k = 0; k < 3; ++k) soup.positions.push_back(mesh.corner(t, k));
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(Simplify, ATessellatedPlaneBecomesTwoTriangles) {
  TriangleMesh plane = test::plane(100, 60, 50, 30);
  const SimplifyResult r = simplify(plane, within(0.01));
  EXPECT_EQ(r.triangles_before, 3000u);
  EXPECT_EQ(r.mesh.triangles.size(), 2u);
  EXPECT_NEAR(test::surface_area(r.mesh), 6000, 1e-9);
  EXPECT_LE(r.deviation.bound(), 0.01);
  EXPECT_EQ(r.stop, StopReason::converged);
}

TEST(Simplify, ASubdividedCubeBecomesTwelveTriangles) {
  for (const Index n : {2u, 7u, 20u}) {
    const SimplifyResult r = simplify(subdivided_cube(10, n), within(0.01));
    EXPECT_EQ(r.mesh.triangles.size(), 12u) << n;
    EXPECT_EQ(r.mesh.positions.size(), 8u);
    EXPECT_NEAR(test::enclosed_volume(r.mesh), 1000, 1e-9);
  }
}

TEST(Simplify, SoupsAreJoined) {
  EXPECT_EQ(simplify(as_soup(test::plane(10, 10, 8, 8)), within(0.01)).mesh.triangles.size(), 2u);
}

/// Corners on the circle stay on it, so s sides leave r (1 - cos(pi / s)): no fewer than the sides that the
/// tolerance demands, and measured within it.
TEST(Simplify, ACylinderKeepsTheSidesThatTheToleranceDemands) {
  const double r = 20;
  const TriangleMesh cylinder = test::cylinder(r, 30, 360, 20);
  std::size_t last = cylinder.triangles.size() + 1;
  for (const double tolerance : {0.01, 0.05, 0.2, 1.0}) {
    const SimplifyResult result = simplify(cylinder, within(tolerance));
    const double least_sides = std::numbers::pi / std::acos(1 - tolerance / r);
    EXPECT_LE(result.deviation.bound(), tolerance);
    EXPECT_LE(result.deviation.value(), result.deviation.bound());
    const DeviationResult measured = surface_deviation(cylinder, result.mesh);
    EXPECT_LE(measured.value(), tolerance);
    EXPECT_NEAR(measured.value(), result.deviation.value(), 0.1 * tolerance);
    EXPECT_GE(result.mesh.triangles.size(), 2 * static_cast<std::size_t>(least_sides));
    EXPECT_LE(result.mesh.triangles.size(), 2 * static_cast<std::size_t>(3 * least_sides));
    EXPECT_LT(result.mesh.triangles.size(), last);
    last = result.mesh.triangles.size();
    EXPECT_EQ(mesh_statistics(result.mesh).boundary_loops, 2u);
  }
}

TEST(Simplify, MorePassesLeaveFewerTrianglesWithinTheSameTolerance) {
  const TriangleMesh torus = test::torus(20, 6, 150, 80);
  SimplifyOptions options = within(0.05);
  options.passes = 1;
  const SimplifyResult one = simplify(torus, options);
  options.passes = 3;
  const SimplifyResult three = simplify(torus, options);
  EXPECT_LT(three.mesh.triangles.size(), one.mesh.triangles.size());
  EXPECT_LE(three.deviation.bound(), 0.05);
  EXPECT_EQ(mesh_statistics(three.mesh).boundary_loops, 0u);
  EXPECT_EQ(mesh_statistics(three.mesh).nonmanifold_edges, 0u);
  ASSERT_GE(three.trace.size(), 3u);
  EXPECT_EQ(three.trace.front().error, 1);
  for (std::size_t i = 1; i < three.trace.size(); ++i) {
    EXPECT_GE(three.trace[i].seconds, three.trace[i - 1].seconds);
    EXPECT_LE(three.trace[i].error, three.trace[i - 1].error);
  }
}

TEST(Simplify, StopsAtTheTarget) {
  SimplifyOptions options;
  options.target_triangles = 500;
  const SimplifyResult r = simplify(test::uv_sphere(10, 60, 60), options);
  EXPECT_LE(r.mesh.triangles.size(), 500u);
  EXPECT_GE(r.mesh.triangles.size(), 480u);
  EXPECT_EQ(r.stop, StopReason::converged);
  EXPECT_GT(r.deviation.value(), 0);
  options.tolerance_mm = 1e-4;
  const SimplifyResult limited = simplify(test::uv_sphere(10, 60, 60), options);
  EXPECT_GT(limited.mesh.triangles.size(), 500u);
  EXPECT_EQ(limited.stop, StopReason::iteration_limit);
  EXPECT_LE(limited.deviation.bound(), 1e-4);
}

TEST(Simplify, BordersKeepTheirCourseAndAllTheirVerticesWhenLocked) {
  const TriangleMesh saddle = test::saddle(10, 20, 12, 48);
  SimplifyOptions options = within(0.5);
  options.lock_border = true;
  const SimplifyResult locked = simplify(saddle, options);
  std::set<Vec3> kept(locked.mesh.positions.begin(), locked.mesh.positions.end());
  std::size_t border = 0;
  for (const Vec3& p : saddle.positions)
    if (std::hypot(p.x, p.y) > 10 - 1e-9) {
      ++border;
      EXPECT_TRUE(kept.contains(p));
    }
  EXPECT_EQ(border, 48u);
  EXPECT_LT(locked.mesh.triangles.size(), saddle.triangles.size());
  const SimplifyResult open = simplify(saddle, within(0.5));
  EXPECT_LT(open.mesh.triangles.size(), locked.mesh.triangles.size());
  EXPECT_EQ(mesh_statistics(open.mesh).boundary_loops, 1u);
}

/// Sum of the lengths of edges whose two triangles differ in `label`.
template <class Label>
double border_length(const TriangleMesh& mesh, const Label& label) {
  std::map<std::pair<Index, Index>, std::vector<Index>> edges;
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      edges[{a, b}].push_back(t);
    }
  double sum = 0;
  for (const auto& [edge, triangles] : edges)
    if (triangles.size() == 2 && label(triangles[0], edge) != label(triangles[1], edge))
      sum += norm(mesh.positions[edge.first] - mesh.positions[edge.second]);
  return sum;
}

TEST(Simplify, MaterialAndFaceBordersStayWhereTheyAre) {
  for (const bool material : {true, false}) {
    TriangleMesh plane = test::plane(10, 10, 20, 20);
    Values<std::uint32_t>& labels = material ? plane.material : plane.face;
    std::array<double, 2> area{};
    const auto label_area = [](const TriangleMesh& mesh, std::span<const std::uint32_t> of, std::uint32_t which) {
      double sum = 0;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (of[t] == which)
          sum += 0.5 * norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
      return sum;
    };
    for (std::size_t t = 0; t < plane.triangles.size(); ++t) {
      const Vec3 c = (1.0 / 3) * (plane.corner(t, 0) + plane.corner(t, 1) + plane.corner(t, 2));
      labels.push_back(c.x > 2 && c.x < 7 && c.y > 3 && c.y < 8 ? 1 : 0);
    }
    for (std::uint32_t k = 0; k < 2; ++k) area[k] = label_area(plane, labels, k);
    const SimplifyResult r = simplify(plane, within(0.01));
    const auto& result_labels = material ? r.mesh.material : r.mesh.face;
    EXPECT_EQ(area[1], 25);
    for (std::uint32_t k = 0; k < 2; ++k) EXPECT_NEAR(label_area(r.mesh, result_labels, k), area[k], 1e-9);
    EXPECT_LT(r.mesh.triangles.size(), 30u);
    EXPECT_NEAR(border_length(r.mesh, [&](Index t, auto) { return result_labels[t]; }), 20, 1e-9);
    SimplifyOptions merged = within(0.01);
    merged.keep_faces = false;
    if (!material) {
      EXPECT_EQ(simplify(plane, merged).mesh.triangles.size(), 2u);
    }
  }
}

TEST(Simplify, UvStayExactAtVerticesAndSeamsStaySeams) {
  const TriangleMesh cylinder = test::cylinder(10, 20, 120, 8);
  std::map<Vec3, std::set<Vec2>> before;
  for (std::size_t t = 0; t < cylinder.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      before[cylinder.positions[cylinder.triangles[t][k]]].insert(cylinder.uv.values[cylinder.uv.indices[t][k]]);
  const SimplifyResult r = simplify(cylinder, within(0.1));
  ASSERT_EQ(r.mesh.uv.indices.size(), r.mesh.triangles.size());
  EXPECT_LT(r.mesh.triangles.size(), 200u);
  std::set<Vec2> seam;
  double uv_area = 0;
  for (std::size_t t = 0; t < r.mesh.triangles.size(); ++t) {
    std::array<Vec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
      uv[k] = r.mesh.uv.values[r.mesh.uv.indices[t][k]];
      EXPECT_TRUE(before[r.mesh.positions[r.mesh.triangles[t][k]]].contains(uv[k]));
    }
    uv_area += 0.5 * cross(uv[1] - uv[0], uv[2] - uv[0]);
  }
  // The chart is a rectangle and stays one, whole and unfolded.
  EXPECT_NEAR(std::abs(uv_area), test::surface_area(cylinder), 1e-6);
}

TEST(Simplify, TrianglesWithoutValuesStayWithout) {
  TriangleMesh plane = test::plane(10, 10, 10, 10);
  for (std::size_t t = 0; t < plane.triangles.size(); ++t)
    if (plane.corner(t, 0).x + plane.corner(t, 1).x + plane.corner(t, 2).x > 15)
      plane.uv.indices[t] = {k_no_value, k_no_value, k_no_value};
  const SimplifyResult r = simplify(plane, within(0.01));
  EXPECT_LT(r.mesh.triangles.size(), 12u);
  double with = 0;
  for (std::size_t t = 0; t < r.mesh.triangles.size(); ++t)
    if (r.mesh.uv.has_value(t))
      with += 0.5 * norm(cross(r.mesh.corner(t, 1) - r.mesh.corner(t, 0), r.mesh.corner(t, 2) - r.mesh.corner(t, 0)));
  EXPECT_NEAR(with, 50, 5);
}

TEST(Simplify, FacetedNormalsBecomeTheirMeanOverASmoothFan) {
  TriangleMesh plane = test::plane(10, 10, 4, 4);
  for (std::size_t t = 0; t < plane.triangles.size(); ++t) {
    const auto i = static_cast<Index>(t);
    plane.normals.values.push_back(normalized({0, 0.1, 1}));
    plane.normals.indices.push_back({i, i, i});
  }
  const SimplifyResult r = simplify(plane, within(0.01));
  ASSERT_EQ(r.mesh.triangles.size(), 2u);
  ASSERT_EQ(r.mesh.normals.indices.size(), 2u);
  for (const Vec3& n : r.mesh.normals.values) EXPECT_NEAR(norm(n - normalized({0, 0.1, 1})), 0, 1e-12);
}

TEST(Simplify, FeaturesStayEdges) {
  TriangleMesh roof = test::plane(20, 10, 40, 20);
  for (Vec3& p : roof.positions) p.z = std::abs(p.x - 10);  // 90 degrees along x = 10
  const SimplifyResult r = simplify(roof, within(0.1));
  EXPECT_EQ(r.mesh.triangles.size(), 4u);
  EXPECT_NEAR(test::surface_area(r.mesh), 200 * std::numbers::sqrt2, 1e-9);
}

TEST(Simplify, NonManifoldAndFlippedMeshesPass) {
  TriangleMesh fins = test::plane(10, 10, 10, 10);
  TriangleMesh upright = test::plane(10, 10, 10, 10);
  for (Vec3& p : upright.positions) p = {p.x, 5, p.y};  // meets the first along y = 5
  append(fins, upright, {0, 0, 0});
  fins.uv = {};
  for (std::size_t t = 0; t < fins.triangles.size(); t += 3) std::swap(fins.triangles[t][0], fins.triangles[t][1]);
  const SimplifyResult r = simplify(fins, within(0.01));
  EXPECT_LE(r.mesh.triangles.size(), fins.triangles.size());
  EXPECT_LE(surface_deviation(fins, r.mesh).bound(), 0.01);
}

TEST(Simplify, NothingAndDegenerateTrianglesPass) {
  EXPECT_TRUE(simplify(TriangleMesh{}, within(1)).mesh.triangles.empty());
  TriangleMesh point;
  point.positions = {{1, 2, 3}};
  point.triangles = {{0, 0, 0}};
  EXPECT_TRUE(simplify(point, within(1)).mesh.triangles.empty());
}

TEST(Simplify, RefusesBadOptionsAndMeshes) {
  const TriangleMesh plane = test::plane(1, 1, 1, 1);
  EXPECT_THROW(simplify(plane, {}), InvalidInput);
  EXPECT_THROW(simplify(plane, within(-1)), InvalidInput);
  EXPECT_THROW(simplify(plane, within(NAN)), InvalidInput);
  SimplifyOptions options = within(1);
  options.feature_angle_deg = 200;
  EXPECT_THROW(simplify(plane, options), InvalidInput);
  options = within(1);
  options.passes = 0;
  EXPECT_THROW(simplify(plane, options), InvalidInput);
  TriangleMesh broken = plane;
  broken.triangles[0][0] = 77;
  EXPECT_THROW(simplify(broken, within(1)), InvalidInput);
}

/// A closed disc of height 1 with fans of n triangles as lids.
TriangleMesh fan_disc(double radius, Index n) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}};
  for (Index i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    for (const double z : {0.0, 1.0}) mesh.positions.push_back({radius * std::cos(a), radius * std::sin(a), z});
  }
  for (Index i = 0; i < n; ++i) {
    const Index a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % n);
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}, {0, b, a}, {1, a + 1, b + 1}});
  }
  return mesh;
}

/// Fans of thousands of triangles are looked at only now and then; what is left must still be as few as elsewhere.
TEST(Simplify, HubsOfFansGoLikeOtherPlaces) {
  std::size_t few = 0;
  for (const Index n : {200u, 1500u}) {
    const TriangleMesh disc = fan_disc(50, n);
    const SimplifyResult r = simplify(disc, within(0.1));
    EXPECT_LE(surface_deviation(disc, r.mesh).value(), 0.1);
    const MeshStatistics s = mesh_statistics(r.mesh);
    EXPECT_EQ(s.boundary_loops + s.nonmanifold_edges + s.duplicate_triangles + s.flipped_edges, 0u);
    if (few == 0) few = r.mesh.triangles.size();
    EXPECT_LE(r.mesh.triangles.size(), 2 * few) << n;
    EXPECT_GE(r.mesh.triangles.size(), 190u) << "about 50 sides are needed";
  }
}

/// One more collapse would leave a double sheet, or nothing.
TEST(Simplify, AClosedSurfaceStaysOne) {
  for (const TriangleMesh& mesh : {test::uv_sphere(1, 8, 8), test::cube(1)}) {
    const SimplifyResult r = simplify(mesh, within(100));
    const MeshStatistics s = mesh_statistics(r.mesh);
    EXPECT_GE(r.mesh.triangles.size(), 4u);
    EXPECT_EQ(s.boundary_loops + s.nonmanifold_edges + s.duplicate_triangles + s.degenerate_triangles, 0u);
    EXPECT_GT(test::enclosed_volume(r.mesh), 0);
  }
}

/// Normals of the result against those of the input below: nothing folds over.
TEST(Simplify, NoTriangleFlips) {
  const TriangleMesh torus = test::torus(20, 6, 120, 50);
  for (const double tolerance : {0.05, 0.3}) {
    const SimplifyResult r = simplify(torus, within(tolerance));
    for (std::size_t t = 0; t < r.mesh.triangles.size(); ++t) {
      const Vec3 a = r.mesh.corner(t, 0), b = r.mesh.corner(t, 1), c = r.mesh.corner(t, 2);
      const Vec3 centre = (1.0 / 3) * (a + b + c);
      const Vec3 ring = 20 * normalized({centre.x, centre.y, 0});
      EXPECT_GT(dot(cross(b - a, c - a), centre - ring), 0) << t;
    }
  }
}

TEST(Simplify, DoneTwiceItFindsLittleMore) {
  const TriangleMesh torus = test::torus(20, 6, 120, 60);
  const SimplifyResult once = simplify(torus, within(1e-3 * 52)), twice = simplify(once.mesh, within(1e-6));
  EXPECT_EQ(twice.mesh.triangles.size(), once.mesh.triangles.size()) << "within almost nothing nothing goes";
}

TEST(LevelsOfDetail, EachHoldsItsToleranceAndComesFromTheOneBefore) {
  const TriangleMesh torus = test::torus(20, 6, 120, 60);
  const std::vector<double> tolerances{0.02, 0.1, 0.5};
  const std::vector<SimplifyResult> levels = levels_of_detail(torus, tolerances);
  ASSERT_EQ(levels.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LE(surface_deviation(torus, levels[i].mesh).value(), tolerances[i]);
    EXPECT_LE(levels[i].deviation.bound(), tolerances[i]);
    const TriangleMesh& finer = i == 0 ? torus : levels[i - 1].mesh;
    EXPECT_LT(levels[i].mesh.triangles.size(), finer.triangles.size() * 19 / 20);
    const std::set<Vec3> positions(finer.positions.begin(), finer.positions.end());
    for (const Vec3& p : levels[i].mesh.positions) EXPECT_TRUE(positions.contains(p));
  }
  EXPECT_THROW(levels_of_detail(torus, std::vector<double>{0.1, 0.1}), InvalidInput);
  EXPECT_THROW(levels_of_detail(torus, std::vector<double>{0}), InvalidInput);
}

TEST(Simplify, EndsAtTheDeadlineWithWhatHoldsTheTolerance) {
  const TriangleMesh sphere = test::uv_sphere(10, 60, 90);
  for (const double seconds : {-1.0, 0.06, 0.1, 0.3, 1.0}) {
    SCOPED_TRACE(seconds);
    SimplifyOptions options = within(0.2);
    options.deadline = Deadline(seconds);
    const SimplifyResult r = simplify(sphere, options);
    EXPECT_LE(r.deviation.bound(), 0.2);
    EXPECT_LE(surface_deviation(sphere, r.mesh).value(), 0.2);
    EXPECT_LE(r.mesh.triangles.size(), sphere.triangles.size());
    if (seconds > 0) continue;
    EXPECT_EQ(r.stop, StopReason::time_limit);
    EXPECT_EQ(r.mesh.triangles.size(), sphere.triangles.size());
  }
  SimplifyOptions to_share;
  to_share.target_triangles = 100;
  to_share.deadline = Deadline(-1);
  EXPECT_EQ(simplify(sphere, to_share).stop, StopReason::time_limit);
  EXPECT_EQ(simplify(sphere, to_share).mesh.triangles.size(), sphere.triangles.size());
  const std::vector<SimplifyResult> levels = levels_of_detail(sphere, std::vector{0.1, 0.4}, to_share);
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_EQ(levels[1].stop, StopReason::time_limit);
}

TEST(Simplify, ProgressGoesOnWithinOneMeshAndCancels) {
  const TriangleMesh sphere = test::uv_sphere(10, 60, 90);
  std::vector<double> told;
  SimplifyOptions options = within(0.2);
  options.progress = [&](const Progress& done) { return told.push_back(done.fraction), true; };
  simplify(sphere, options);
  EXPECT_GT(told.size(), 20U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_LE(told.back(), 1);
  options.progress = [](const Progress&) { return false; };
  EXPECT_THROW(simplify(sphere, options), Cancelled);
}

}  // namespace
}  // namespace papilla
