// SPDX-License-Identifier: MIT
#include "papilla/param/lscm.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

class BothSolvers : public testing::TestWithParam<LscmSolver> {
 protected:
  LscmOptions options() const {
    LscmOptions o;
    o.solver = GetParam();
    return o;
  }
};
INSTANTIATE_TEST_SUITE_P(Lscm, BothSolvers, testing::Values(LscmSolver::cgal, LscmSolver::hermitian),
                         [](const auto& solver) { return solver.param == LscmSolver::cgal ? "cgal" : "hermitian"; });

TEST_P(BothSolvers, DevelopableChartIsExact) {
  const TriangleMesh mesh = test::grid_mesh(64, 30, test::open_cylinder);  // a regular prism: exactly developable
  const Flattening f = flatten_lscm(mesh, test::one_chart(mesh), options());
  EXPECT_TRUE(f.notes.empty());
  const DistortionReport r = measure_distortion(mesh, f.uv);
  EXPECT_LT(r.maillot_length, 1e-12);
  EXPECT_NEAR(r.symmetric_dirichlet.max, 4, 1e-6);
  EXPECT_NEAR(r.uv_area, r.area_mm2, 1e-6 * r.area_mm2);
}

TEST_P(BothSolvers, GrainStandsUpright) {
  const TriangleMesh mesh = test::grid_mesh(64, 30, test::open_cylinder);
  const Flattening f = flatten_lscm(mesh, test::one_chart(mesh), options());
  const Vec2 origin = f.uv.values[f.uv.indices[0][0]];
  const Vec3 foot = mesh.corner(0, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(f.uv.values[f.uv.indices[t][k]].y - origin.y, mesh.corner(t, static_cast<int>(k)).z - foot.z, 1e-3);
}

TEST_P(BothSolvers, DoubleCurvedPatchIsNearlyConformal) {
  const TriangleMesh mesh = test::dashboard_mesh(118, 42);
  const Flattening f = flatten_lscm(mesh, test::one_chart(mesh), options());
  EXPECT_TRUE(f.notes.empty());
  const DistortionReport r = measure_distortion(mesh, f.uv);
  EXPECT_EQ(r.flipped, 0u);
  EXPECT_EQ(r.overlap_area_fraction, 0);
  EXPECT_LT(r.angle_error_deg.mean, 0.25);
  // Measured values of the two weightings on this surface; they differ by the weighting only.
  EXPECT_NEAR(r.symmetric_dirichlet.mean, GetParam() == LscmSolver::cgal ? 4.0377 : 4.0318, 5e-4);
}

TEST_P(BothSolvers, HolesAreWelcome) {
  TriangleMesh mesh = test::plane(40, 30, 40, 30);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const Vec3 c = (1.0 / 3) * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]);
    return std::hypot(c.x - 15, c.y - 15) < 5 || std::hypot(c.x - 30, c.y - 12) < 4;
  });
  const Flattening f = flatten_lscm(mesh, test::one_chart(mesh), options());
  EXPECT_TRUE(f.notes.empty());
  EXPECT_NEAR(measure_distortion(mesh, f.uv).symmetric_dirichlet.max, 4, 1e-9);
}

TEST_P(BothSolvers, OneTriangle) {
  TriangleMesh mesh;
  mesh.positions = {{1, 2, 3}, {4, 2, 3}, {1, 6, 4}};
  mesh.triangles = {{0, 1, 2}};
  const Flattening f = flatten_lscm(mesh, test::one_chart(mesh), options());
  EXPECT_TRUE(f.notes.empty());
  EXPECT_NEAR(measure_distortion(mesh, f.uv).symmetric_dirichlet.max, 4, 1e-12);
}

TEST_P(BothSolvers, ScaleDoesNotChangeTheShape) {
  TriangleMesh mesh = test::dashboard_mesh(30, 10);
  const double original =
      measure_distortion(mesh, flatten_lscm(mesh, test::one_chart(mesh), options()).uv).symmetric_dirichlet.mean;
  for (const double scale : {1e-9, 1e3}) {
    TriangleMesh scaled = mesh;
    for (Vec3& p : scaled.positions) p = scale * p;
    const Flattening f = flatten_lscm(scaled, test::one_chart(scaled), options());
    EXPECT_TRUE(f.notes.empty()) << f.notes.front().reason;
    EXPECT_NEAR(measure_distortion(scaled, f.uv).symmetric_dirichlet.mean, original, 1e-6);
  }
}

TEST(Lscm, ClosedChartFallsBackWithAReason) {
  const TriangleMesh mesh = test::cube(5);
  const Flattening f = flatten_lscm(mesh, test::one_chart(mesh));
  ASSERT_EQ(f.notes.size(), 1u);
  EXPECT_NE(f.notes[0].reason.find("closed"), std::string::npos);
  EXPECT_EQ(f.charts.count, 6u);
  EXPECT_EQ(measure_distortion(mesh, f.uv).flipped, 0u);
}

TEST(Lscm, StrictModeNamesChartAndReason) {
  const TriangleMesh torus = test::torus(100, 30, 20, 10);
  LscmOptions strict;
  strict.fall_back = false;
  try {
    flatten_lscm(torus, test::one_chart(torus), strict);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("chart[0]"), std::string::npos);
  }
  TriangleMesh handle = torus;
  handle.triangles.pop_back();
  try {
    flatten_lscm(handle, test::one_chart(handle), strict);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("genus 1"), std::string::npos);
  }
}

TEST(Lscm, UnconnectedChartFallsBack) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Flattening f = flatten_lscm(mesh, test::one_chart(mesh));
  ASSERT_EQ(f.notes.size(), 1u);
  EXPECT_EQ(f.charts.count, 2u);
}

TEST(Lscm, NearlyClosedSphereIsValidOrSaysWhyNot) {
  TriangleMesh mesh = test::uv_sphere(10, 40, 80);
  mesh.triangles.resize(mesh.triangles.size() - 80);
  const Flattening f = flatten_lscm(mesh, test::one_chart(mesh));
  const DistortionReport r = measure_distortion(mesh, f.uv);
  EXPECT_EQ(r.flipped, 0u);
  EXPECT_EQ(r.overlap_within_charts, 0);
}

TEST(Lscm, TrianglesWithoutAreaGiveFiniteUv) {
  for (const LscmSolver solver : {LscmSolver::cgal, LscmSolver::hermitian}) {
    TriangleMesh mesh = test::dashboard_mesh(20, 8);
    // Slides interior vertices onto the middle of an edge of one of their triangles.
    for (const Index v : {50u, 92u, 117u}) {
      for (const Triangle& t : mesh.triangles)
        if (t[0] == v) {
          mesh.positions[v] = 0.5 * (mesh.positions[t[1]] + mesh.positions[t[2]]);
          break;
        }
    }
    LscmOptions options;
    options.solver = solver;
    const Flattening f = flatten_lscm(mesh, test::one_chart(mesh), options);
    for (const Vec2 p : f.uv.values) EXPECT_TRUE(is_finite(p));
    const DistortionReport r = measure_distortion(mesh, f.uv);
    EXPECT_GE(r.degenerate_3d, 3u);
    EXPECT_EQ(r.flipped, 0u);
  }
}

TEST(Lscm, ChartsKeepTheirNumbersAndAreas) {
  const TriangleMesh mesh = test::dashboard_mesh(40, 16);
  ChartSet charts = test::one_chart(mesh);
  charts.count = 2;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    charts.of_triangle[t] = mesh.corner(t, 0).x + mesh.corner(t, 1).x + mesh.corner(t, 2).x > 2000 ? 1 : 0;
  const Flattening f = flatten_lscm(mesh, charts);
  EXPECT_EQ(f.charts.of_triangle, charts.of_triangle);
  EXPECT_GT(f.charts.seam_length_mm, 500);
  double area[2] = {0, 0}, uv_area[2] = {0, 0};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& i = f.uv.indices[t];
    area[charts.of_triangle[t]] +=
        0.5 * norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
    uv_area[charts.of_triangle[t]] +=
        0.5 * cross(f.uv.values[i[1]] - f.uv.values[i[0]], f.uv.values[i[2]] - f.uv.values[i[0]]);
  }
  EXPECT_NEAR(uv_area[0], area[0], 1e-9 * area[0]);
  EXPECT_NEAR(uv_area[1], area[1], 1e-9 * area[1]);
}

TEST(Lscm, SameBytesForAnyNumberOfThreads) {
  const TriangleMesh mesh = test::torus(100, 30, 40, 20);
  const ChartSet charts = flatten_triplanar(mesh).flattening.charts;
  std::vector<CornerAttribute<Vec2>> results;
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(flatten_lscm(mesh, charts).uv);
  }
  EXPECT_EQ(results[0].values, results[1].values);
  EXPECT_EQ(results[0].values, results[2].values);
  EXPECT_EQ(results[0].indices, results[2].indices);
}

TEST(Lscm, EmptyInputAndBadCharts) {
  EXPECT_TRUE(flatten_lscm({}, {}).uv.empty());
  const TriangleMesh mesh = test::cube(1);
  EXPECT_THROW(flatten_lscm(mesh, {}), InvalidInput);
  ChartSet charts = test::one_chart(mesh);
  charts.of_triangle[4] = 7;
  EXPECT_THROW(flatten_lscm(mesh, charts), InvalidInput);
}

}  // namespace
}  // namespace papilla
