// SPDX-License-Identifier: MIT
#include "papilla/param/triplanar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

std::size_t lone_charts(const ChartSet& charts) {
  std::vector<int> size(charts.count, 0);
  for (const std::uint32_t c : charts.of_triangle) ++size[c];
  return static_cast<std::size_t>(std::count(size.begin(), size.end(), 1));
}

/// What every result promises, checked by the referee.
void expect_valid(const TriangleMesh& mesh, const TriplanarResult& result) {
  const Flattening& f = result.flattening;
  ASSERT_EQ(f.uv.indices.size(), mesh.triangles.size());
  ASSERT_EQ(f.charts.of_triangle.size(), mesh.triangles.size());
  const DistortionReport r = measure_distortion(mesh, f.uv);
  EXPECT_EQ(r.flipped, 0u);
  EXPECT_EQ(r.mirrored_charts, 0u);
  EXPECT_EQ(r.degenerate_uv, 0u);
  // Charts that touch in uv count as one for the referee: place each far from the others.
  CornerAttribute<Vec2> apart = f.uv;
  std::vector<char> moved(apart.values.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index i : apart.indices[t])
      if (!moved[i]) apart.values[i].x += 1e5 * f.charts.of_triangle[t], moved[i] = 1;
  const DistortionReport of_charts = measure_distortion(mesh, apart);
  EXPECT_EQ(of_charts.charts, f.charts.count);
  EXPECT_EQ(of_charts.overlapping_triangles, 0u);
}

TEST(Triplanar, CubeHasSixIsometricFaces) {
  const TriangleMesh mesh = test::cube(20);
  const TriplanarResult result = flatten_triplanar(mesh);
  EXPECT_EQ(result.flattening.charts.count, 6u);
  expect_valid(mesh, result);
  EXPECT_NEAR(measure_distortion(mesh, result.flattening.uv).symmetric_dirichlet.max, 4, 1e-12);
  EXPECT_NEAR(result.flattening.charts.seam_length_mm, 12 * 20, 1e-9);
}

TEST(Triplanar, UvAreTheProjectedCoordinates) {
  const TriangleMesh mesh = test::cube(20);
  const TriplanarResult result = flatten_triplanar(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint8_t label = result.label[t];
    const ProjectionAxes axes = projection_axes(label >> 1, label & 1, UpAxis::z);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.positions[mesh.triangles[t][k]];
      const double c[3] = {p.x, p.y, p.z};
      const Vec2 uv = result.flattening.uv.values[result.flattening.uv.indices[t][k]];
      EXPECT_EQ(uv, (Vec2{axes.u_sign * c[axes.u_axis], axes.v_sign * c[axes.v_axis]}));
    }
  }
}

TEST(Triplanar, TiesTakeTheEarlierAxis) {
  TriangleMesh mesh;
  mesh.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}};  // normal (1, 1, 1)
  EXPECT_EQ(flatten_triplanar(mesh).label[0], 0);
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, -1}};  // normal (0, 1, 1)
  EXPECT_EQ(flatten_triplanar(mesh).label[0], 2);
}

TEST(Triplanar, CurvedShapesAreValid) {
  for (const TriangleMesh& mesh :
       {test::torus(1000, 250, 80, 40), test::dashboard_mesh(60, 21), test::hemisphere_mesh(30, 60),
        test::grid_mesh(32, 160, test::grab_handle, 0.15), test::uv_sphere(10, 40, 80)}) {
    const TriplanarResult result = flatten_triplanar(mesh);
    expect_valid(mesh, result);
    EXPECT_EQ(lone_charts(result.flattening.charts), 0u);
    EXPECT_EQ(result.folded_sheets, 0u);
  }
}

TEST(Triplanar, NumberOfChartsDoesNotGrowWithTessellation) {
  EXPECT_EQ(flatten_triplanar(test::grid_mesh(32, 160, test::grab_handle, 0.15)).flattening.charts.count,
            flatten_triplanar(test::grid_mesh(64, 320, test::grab_handle, 0.15)).flattening.charts.count);
  EXPECT_EQ(flatten_triplanar(test::hemisphere_mesh(30, 60)).flattening.charts.count, 5u);
  EXPECT_EQ(flatten_triplanar(test::torus(1000, 250, 80, 40)).flattening.charts.count, 10u);
}

TEST(Triplanar, FoldedSheetIsSplit) {
  const TriangleMesh ramp = test::grid_mesh(200, 8, test::helical_ramp);
  const TriplanarResult result = flatten_triplanar(ramp);
  EXPECT_EQ(result.folded_sheets, 1u);
  EXPECT_GE(result.flattening.charts.count, 3u);  // two and a half turns
  EXPECT_LE(result.flattening.charts.count, 5u);
  expect_valid(ramp, result);
}

TEST(Triplanar, StepsThatTouchInProjectionAreNotSplit) {
  // Two levels over x < 5 and x > 5 joined by a ramp in one corner: their edges project onto one line.
  TriangleMesh mesh = test::grid_mesh(10, 10, [](double s, double t) { return Vec3{10 * s, 10 * t, 0}; });
  const std::size_t original = mesh.positions.size();
  std::vector<Index> upper(original);
  for (Index v = 0; v < original; ++v) {
    upper[v] = v;
    const Vec3 p = mesh.positions[v];
    if (std::abs(p.x - 5) > 1e-9 || p.y < 1.5) continue;
    upper[v] = static_cast<Index>(mesh.positions.size());
    mesh.positions.push_back({p.x, p.y, p.y - 1});
  }
  for (Triangle& t : mesh.triangles) {
    const double centre = (mesh.positions[t[0]].x + mesh.positions[t[1]].x + mesh.positions[t[2]].x) / 3;
    if (centre > 5)
      for (Index& v : t) v = upper[v];
  }
  const TriplanarResult result = flatten_triplanar(mesh);
  EXPECT_EQ(result.folded_sheets, 0u);
}

TEST(Triplanar, NoiseMakesNoChartsOfOneTriangle) {
  std::mt19937 generator(5);
  TriangleMesh mesh = test::uv_sphere(100, 60, 120);
  for (Vec3& p : mesh.positions) p = (1 + 0.01 * (static_cast<double>(generator()) / 4294967296.0 - 0.5)) * p;
  const TriplanarResult result = flatten_triplanar(mesh);
  expect_valid(mesh, result);
  EXPECT_EQ(lone_charts(result.flattening.charts), 0u);
  EXPECT_GT(result.flattening.trace.front().error, 0);  // there were lone triangles before smoothing
}

TEST(Triplanar, RotatedMeshWithTheOtherUpAxisHasTheSameUv) {
  const TriangleMesh z_up = test::grid_mesh(32, 160, test::grab_handle, 0.15);  // no ties, which the axis order decides
  TriangleMesh y_up = z_up;
  for (Vec3& p : y_up.positions) p = {p.x, p.z, -p.y};
  const TriplanarResult a = flatten_triplanar(z_up), b = flatten_triplanar(y_up, {.up = UpAxis::y});
  const double mean_a = measure_distortion(z_up, a.flattening.uv).symmetric_dirichlet.mean;
  EXPECT_NEAR(measure_distortion(y_up, b.flattening.uv).symmetric_dirichlet.mean, mean_a, 1e-9);
  EXPECT_EQ(a.flattening.charts.count, b.flattening.charts.count);
}

TEST(Triplanar, BorderJumpIsCountedModuloTheTile) {
  // An L of two unit-wide strips: the edge y = 0, z = 10 is (x, 10) on the front and (x, 0) on the top.
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {4, 0, 10}, {0, 0, 10}, {4, 7, 10}, {0, 7, 10}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}};
  const BorderJump plain = flatten_triplanar(mesh).border_jump;
  EXPECT_NEAR(plain.seam_mm, 4, 1e-12);
  EXPECT_NEAR(plain.mean_mm, 10, 1e-12);
  EXPECT_NEAR(plain.max_mm, 10, 1e-12);
  EXPECT_NEAR(plain.rms_mm, 10, 1e-12);
  EXPECT_NEAR(flatten_triplanar(mesh, {.tile_mm = {3, 8}}).border_jump.mean_mm, 2, 1e-12);
  EXPECT_NEAR(flatten_triplanar(mesh, {.tile_mm = {8, 8}}).border_jump.mean_mm, 2, 1e-12);
  EXPECT_NEAR(flatten_triplanar(mesh, {.tile_mm = {5, 5}}).border_jump.rms_mm, 0, 1e-12);
}

TEST(Triplanar, TrianglesWithoutAreaFollowTheirNeighbours) {
  TriangleMesh mesh = test::cube(10);
  const Index middle = static_cast<Index>(mesh.positions.size());
  const Triangle first = mesh.triangles[0];  // splits an edge of the first triangle with a triangle without area
  mesh.positions.push_back(0.5 * (mesh.positions[first[0]] + mesh.positions[first[1]]));
  mesh.triangles[0] = {first[0], middle, first[2]};
  mesh.triangles.push_back({middle, first[1], first[2]});
  mesh.triangles.push_back({first[0], first[1], middle});
  const TriplanarResult result = flatten_triplanar(mesh);
  EXPECT_EQ(result.flattening.charts.count, 6u);
  for (const Vec2 p : result.flattening.uv.values) EXPECT_TRUE(is_finite(p));
}

TEST(Triplanar, SameInputSameBytes) {
  const TriangleMesh mesh = test::torus(1000, 250, 60, 30);
  const TriplanarResult a = flatten_triplanar(mesh), b = flatten_triplanar(mesh);
  EXPECT_EQ(a.flattening.uv.values, b.flattening.uv.values);
  EXPECT_EQ(a.flattening.uv.indices, b.flattening.uv.indices);
}

TEST(Triplanar, EmptyAndNonManifoldInput) {
  EXPECT_EQ(flatten_triplanar({}).flattening.charts.count, 0u);
  TriangleMesh book;  // three leaves on one edge, and a triangle with a repeated corner
  book.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0.2, 0}, {-1, -0.2, 0}};
  book.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 1, 1}};
  const TriplanarResult result = flatten_triplanar(book);
  EXPECT_EQ(result.flattening.charts.count, 4u);
}

TEST(Triplanar, RefusesBadInput) {
  TriangleMesh mesh = test::cube(1);
  EXPECT_THROW(flatten_triplanar(mesh, {.smoothing_cosine = 2}), InvalidInput);
  EXPECT_THROW(flatten_triplanar(mesh, {.absorption_cosine = 0}), InvalidInput);
  EXPECT_THROW(flatten_triplanar(mesh, {.tile_mm = {-1, 0}}), InvalidInput);
  mesh.triangles[3][1] = 8;
  EXPECT_THROW(flatten_triplanar(mesh), InvalidInput);
  mesh = test::cube(1);
  mesh.positions[2].z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(flatten_triplanar(mesh), InvalidInput);
}

}  // namespace
}  // namespace papilla
