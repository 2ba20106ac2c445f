// SPDX-License-Identifier: MIT
#include "papilla/param/measure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

using test::uv_per_vertex;

void expect_isometric(const DistortionReport& r, double tolerance) {
  EXPECT_NEAR(r.stretch_l2, 1, tolerance);
  EXPECT_NEAR(r.stretch_linf, 1, tolerance);
  EXPECT_NEAR(r.symmetric_dirichlet.mean, 4, tolerance);
  EXPECT_NEAR(r.symmetric_dirichlet.max, 4, tolerance);
  EXPECT_NEAR(r.conformal.max, 1, tolerance);
  EXPECT_NEAR(r.area_ratio.min, 1, tolerance);
  EXPECT_NEAR(r.area_ratio.max, 1, tolerance);
  EXPECT_NEAR(r.angle_error_deg.max, 0, 100 * tolerance);
  EXPECT_NEAR(r.edge_length_error, 0, tolerance);
  EXPECT_NEAR(r.maillot_length, 0, tolerance);
  EXPECT_NEAR(r.maillot_area, 0, tolerance);
  EXPECT_NEAR(r.levy_orthogonality, 0, tolerance);
  EXPECT_NEAR(r.levy_homogeneity, 0, 100 * tolerance);
  EXPECT_NEAR(r.green_lagrange, 0, tolerance);
  EXPECT_EQ(r.flipped, 0u);
  EXPECT_EQ(r.mirrored_charts, 0u);
  EXPECT_EQ(r.overlap_area_fraction, 0);
}

/// n × n unit squares in z = 0, all cut along (1, 1).
TriangleMesh squares(int n) {
  TriangleMesh mesh = test::grid_mesh(n, n, [n](double s, double t) { return Vec3{n * s, n * t, 0}; });
  return mesh;
}

TEST(Measure, UnrolledCylinderIsIsometric) {
  TriangleMesh mesh = test::cylinder(30, 100, 48, 20);
  const DistortionReport r = measure_distortion(mesh, mesh.uv);
  expect_isometric(r, 1e-10);
  EXPECT_EQ(r.charts, 1u);
  EXPECT_NEAR(r.seam_length_mm, 100, 1e-10);
  EXPECT_EQ(r.triangles, mesh.triangles.size());
  EXPECT_EQ(r.measured_triangles, mesh.triangles.size());
}

TEST(Measure, ScaleTranslationAndRotationOfUvDoNotMatter) {
  const TriangleMesh mesh = test::plane(30, 20, 6, 5);
  const auto uv = uv_per_vertex(mesh, [](Vec3 p) {
    return Vec2{7 + 0.01 * (0.6 * p.x - 0.8 * p.y), 0.01 * (0.8 * p.x + 0.6 * p.y)};
  });
  expect_isometric(measure_distortion(mesh, uv), 1e-11);
}

TEST(Measure, UnrolledConeIsIsometric) {
  // A fan of flat triangles unrolls exactly: every apex angle is kept.
  const TriangleMesh mesh = test::cone(30, 40, 24);
  const double slant = 50, angle = 2 * std::asin(30 * std::sin(std::numbers::pi / 24) / slant);
  CornerAttribute<Vec2> uv;
  Index apex = 0;
  for (Index v = 0; v < mesh.positions.size(); ++v)
    if (mesh.positions[v].z > 39) apex = v;
  uv.values = {{0, 0}};
  for (int i = 0; i <= 24; ++i) uv.values.push_back({slant * std::cos(i * angle), slant * std::sin(i * angle)});
  const auto number = [&](Index v) {
    const double longitude = std::atan2(mesh.positions[v].y, mesh.positions[v].x);
    return static_cast<int>(std::lround((longitude < -1e-9 ? longitude + 2 * std::numbers::pi : longitude) * 12 /
                                        std::numbers::pi)) %
           24;
  };
  for (const Triangle& t : mesh.triangles) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[k] == apex) continue;
      const Index before = t[(k + 2) % 3];
      int i = number(t[k]);
      if (i == 0 && before != apex) i = 24;  // the end of the last triangle's rim edge
      corners[k] = static_cast<Index>(1 + i);
    }
    uv.indices.push_back(corners);
  }
  const DistortionReport r = measure_distortion(mesh, uv);
  expect_isometric(r, 1e-10);
  EXPECT_NEAR(r.seam_length_mm, slant, 1e-10);
}

TEST(Measure, AffineStretchHasTheClosedForms) {
  const int n = 6;
  const double a = 3, b = 0.75, k = a / b;
  const TriangleMesh mesh = squares(n);
  const auto uv = uv_per_vertex(mesh, [&](Vec3 p) { return Vec2{a * p.x, b * p.y}; });
  MeasureOptions options;
  options.texture_px = {512, 128};
  options.uv_per_texture = {2, 4};
  const DistortionReport r = measure_distortion(mesh, uv, options);
  const double tolerance = 1e-12;
  EXPECT_NEAR(r.symmetric_dirichlet.mean, 2 * (k + 1 / k), tolerance);
  EXPECT_NEAR(r.symmetric_dirichlet.max, 2 * (k + 1 / k), tolerance);
  EXPECT_NEAR(r.stretch_l2, std::sqrt(0.5 * (k + 1 / k)), tolerance);
  EXPECT_NEAR(r.stretch_linf, std::sqrt(k), tolerance);
  EXPECT_NEAR(r.conformal.mean, k, tolerance);
  EXPECT_NEAR(r.area_ratio.mean, 1, tolerance);
  const double turned = 45 - std::atan(b / a) * 180 / std::numbers::pi;
  EXPECT_NEAR(r.angle_error_deg.mean, 2 * turned / 3, 1e-10);
  EXPECT_NEAR(r.levy_orthogonality, 0, tolerance);
  EXPECT_NEAR(r.levy_homogeneity, 0, 1e-10);
  EXPECT_NEAR(r.green_lagrange, (k - 1) * (k - 1) + (1 / k - 1) * (1 / k - 1), 1e-10);
  EXPECT_NEAR(r.maillot_area, 0, tolerance);
  // n (n + 1) edges each way of length 1, n² diagonals of squared length 2.
  const double straight = n * (n + 1), diagonal = n * n, of_diagonal = k + 1 / k - 2;
  const double energy =
      straight * ((k - 1) * (k - 1) + (1 / k - 1) * (1 / k - 1)) + diagonal * of_diagonal * of_diagonal / 2;
  EXPECT_NEAR(r.maillot_length, energy / (2 * straight + 2 * diagonal), tolerance);
  const double lengths = straight * (std::abs(std::sqrt(k) - 1) + std::abs(1 / std::sqrt(k) - 1)) +
                         diagonal * std::abs(std::sqrt(k + 1 / k) - std::sqrt(2.0));
  EXPECT_NEAR(r.edge_length_error, lengths / (2 * straight + std::sqrt(2.0) * diagonal), tolerance);
  EXPECT_NEAR(r.texel_density.min, std::sqrt(a * 256 * b * 32), 1e-9);
  EXPECT_NEAR(r.texel_density.max, std::sqrt(a * 256 * b * 32), 1e-9);
  EXPECT_NEAR(r.symmetric_dirichlet_percentiles.p99, 2 * (k + 1 / k), tolerance);
}

TEST(Measure, ShearHasTheClosedForms) {
  const double c = 0.5;
  const TriangleMesh mesh = squares(4);
  const DistortionReport r = measure_distortion(mesh, uv_per_vertex(mesh, [&](Vec3 p) {
                                                  return Vec2{p.x + c * p.y, p.y};
                                                }));
  EXPECT_NEAR(r.levy_orthogonality, c, 1e-12);  // ∇u · ∇v = (1, c) · (0, 1)
  EXPECT_NEAR(r.area_ratio.max, 1, 1e-12);
  EXPECT_NEAR(r.symmetric_dirichlet.mean, 2 * (2 + c * c), 1e-12);  // |J|² = 2 + c², det = 1
}

TEST(Measure, HomogeneitySeesTheJumpOfTheGradient) {
  const int n = 8;
  const TriangleMesh mesh = squares(n);
  // Twice as fast right of the middle: ∂u/∂x jumps by 1 over the n edges of the line x = n/2.
  const auto uv = uv_per_vertex(mesh, [&](Vec3 p) { return Vec2{p.x < n / 2.0 ? p.x : 2 * p.x - n / 2.0, p.y}; });
  const DistortionReport r = measure_distortion(mesh, uv);
  const double interior = 2.0 * n * (n - 1) + n * n;
  EXPECT_NEAR(r.levy_homogeneity, std::sqrt(2.0 / 3 * n / interior), 1e-12);
}

TEST(Measure, HomogeneityWeighsAnEdgeByTheAreasOfBothItsTriangles) {
  // Areas 1 and 3, and twice as fast on the right: the only jump is 1, less the scale that makes 7 of uv 4.
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 2, 0}, {-1, 1, 0}, {3, 1, 0}};
  for (const bool small_first : {true, false}) {
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    if (!small_first) std::swap(mesh.triangles[0], mesh.triangles[1]);
    const auto uv = uv_per_vertex(mesh, [](Vec3 p) { return Vec2{p.x < 0 ? p.x : 2 * p.x, p.y}; });
    EXPECT_NEAR(measure_distortion(mesh, uv).levy_homogeneity, std::sqrt(4.0 / 7), 1e-12);
  }
}

TEST(Measure, PercentilesAndMeansWeighByArea) {
  // Area 3 with σ = (1, 1), area 1 stretched: half and ninety percent fall on either side.
  const TriangleMesh mesh = squares(4);
  const auto uv = uv_per_vertex(mesh, [](Vec3 p) { return Vec2{p.x < 3 ? p.x : 3 + 4 * (p.x - 3), p.y}; });
  const DistortionReport r = measure_distortion(mesh, uv);
  const double s2 = 16.0 / (12 + 16);
  EXPECT_NEAR(r.symmetric_dirichlet_percentiles.p50, 2 * s2 + 2 / s2, 1e-12);
  EXPECT_NEAR(r.symmetric_dirichlet_percentiles.p90, 17 * s2 + (1 + 1.0 / 16) / s2, 1e-12);
  EXPECT_NEAR(r.symmetric_dirichlet.mean, 0.75 * (2 * s2 + 2 / s2) + 0.25 * (17 * s2 + (1 + 1.0 / 16) / s2), 1e-12);
  EXPECT_NEAR(r.area_ratio.min, s2, 1e-12);
  EXPECT_NEAR(r.area_ratio.max, 4 * s2, 1e-12);
  EXPECT_NEAR(r.area_ratio.mean, 1, 1e-12);
  // Green and Lagrange's strain is that of the way from uv to the surface: triangles weigh by their area in uv.
  const double small = 2 * (1 / s2 - 1) * (1 / s2 - 1),
               large = (1 / (16 * s2) - 1) * (1 / (16 * s2) - 1) + (1 / s2 - 1) * (1 / s2 - 1);
  EXPECT_NEAR(r.green_lagrange, 0.75 * s2 * small + 0.25 * 4 * s2 * large, 1e-10);
}

TEST(Measure, StereographicSphereIsConformalInTheLimit) {
  const double half_angle = 1.2;
  double last = 180;
  for (const Index rings : {8u, 16u, 32u}) {
    const TriangleMesh mesh = test::spherical_cap(100, half_angle, rings, 4 * rings);
    const auto uv = uv_per_vertex(mesh, [](Vec3 p) { return (2 / (1 + p.z / 100)) * Vec2{p.x, p.y}; });
    const DistortionReport r = measure_distortion(mesh, uv);
    EXPECT_EQ(r.flipped, 0u);
    EXPECT_LT(r.angle_error_deg.mean, 0.55 * last);
    last = r.angle_error_deg.mean;
    if (rings == 32) {
      // The area grows by (2 / (1 + cos θ))², from 1 at the pole.
      const double grown = std::pow(2 / (1 + std::cos(half_angle)), 2);
      EXPECT_NEAR(r.area_ratio.max / r.area_ratio.min, grown, 0.04 * grown);
      EXPECT_NEAR(r.area_ratio.mean, 1, 1e-12);
    }
  }
  EXPECT_LT(last, 1);
}

/// A square of four triangles around a centre.
TriangleMesh fan() {
  TriangleMesh mesh;
  mesh.positions = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 0, 0}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  return mesh;
}

TEST(Measure, FlippedTriangleIsFoundAndOverlaps) {
  const TriangleMesh mesh = fan();
  auto uv = uv_per_vertex(mesh, [](Vec3 p) { return Vec2{p.x, p.y}; });
  uv.values[4] = {3, 0};  // pulled out over the right side: covers a triangle of area 2 twice, the square once
  const DistortionReport r = measure_distortion(mesh, uv);
  EXPECT_EQ(r.flipped, 1u);
  EXPECT_TRUE(r.per_triangle[3].flipped);
  EXPECT_EQ(r.mirrored_charts, 0u);
  EXPECT_NEAR(r.overlap_area_fraction, 2.0 / 6, 1e-4);
  EXPECT_NEAR(r.overlap_within_charts, 2.0 / 6, 1e-4);
  EXPECT_EQ(r.overlapping_triangles, 4u);
}

TEST(Measure, TinyFoldIsNeverReportedAsNone) {
  TriangleMesh mesh = squares(100);
  auto uv = uv_per_vertex(mesh, [](Vec3 p) { return Vec2{p.x, p.y}; });
  uv.values[50 * 101 + 50].x += 1.001;
  const DistortionReport r = measure_distortion(mesh, uv);
  EXPECT_GT(r.flipped, 0u);
  EXPECT_GT(r.overlap_area_fraction, 0);
  EXPECT_LT(r.overlap_area_fraction, 1e-4);
}

TEST(Measure, MirroredChartIsCountedAndNotFlipped) {
  const TriangleMesh mesh = fan();
  const DistortionReport r = measure_distortion(mesh, uv_per_vertex(mesh, [](Vec3 p) { return Vec2{-p.x, p.y}; }));
  EXPECT_EQ(r.mirrored_charts, 1u);
  EXPECT_EQ(r.flipped, 0u);
  EXPECT_NEAR(r.symmetric_dirichlet.max, 4, 1e-12);
  EXPECT_NEAR(r.maillot_area, 0, 1e-12);
}

TEST(Measure, OverlapBetweenChartsIsToldFromOverlapWithin) {
  TriangleMesh mesh;
  for (const double x : {0.0, 10.0})
    for (const Vec2 p : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}}) mesh.positions.push_back({x + p.x, p.y, 0});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const auto uv = uv_per_vertex(mesh, [](Vec3 p) { return Vec2{p.x < 5 ? p.x : p.x - 9.5, p.y}; });
  const DistortionReport r = measure_distortion(mesh, uv);
  EXPECT_EQ(r.charts, 2u);
  EXPECT_NEAR(r.overlap_area_fraction, 0.5 / 1.5, 1e-12);
  EXPECT_EQ(r.overlap_within_charts, 0);
  EXPECT_EQ(r.overlapping_within_charts, 0u);
}

TEST(Measure, OverlapNeedNotBeLookedFor) {
  const TriangleMesh mesh = test::cube(1);
  CornerAttribute<Vec2> uv;
  uv.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t t = 0; t < 12; ++t) uv.indices.push_back(t % 2 == 0 ? Triangle{0, 1, 2} : Triangle{0, 2, 3});
  MeasureOptions options;
  options.overlap = false;
  const DistortionReport with = measure_distortion(mesh, uv), without = measure_distortion(mesh, uv, options);
  EXPECT_TRUE(with.has_overlap);
  EXPECT_FALSE(without.has_overlap);
  EXPECT_EQ(without.overlapping_triangles, 0u);
  EXPECT_EQ(without.overlap_area_fraction, 0);
  EXPECT_EQ(without.charts, with.charts);
  EXPECT_EQ(without.stretch_l2, with.stretch_l2);
}

TEST(Measure, CoincidentChartsCoverEverythingTwice) {
  TriangleMesh mesh = test::cube(1);
  CornerAttribute<Vec2> uv;  // every face fills the same square
  uv.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t t = 0; t < 12; ++t) uv.indices.push_back(t % 2 == 0 ? Triangle{0, 1, 2} : Triangle{0, 2, 3});
  EXPECT_NEAR(measure_distortion(mesh, uv).overlap_area_fraction, 1, 1e-9);
}

TEST(Measure, SeamAndPhaseJump) {
  const TriangleMesh mesh = test::plane(20, 10, 2, 1);  // cut in the middle; the right half is moved
  CornerAttribute<Vec2> uv;
  for (const Triangle& t : mesh.triangles) {
    double centre = 0;
    for (const Index v : t) centre += mesh.positions[v].x / 3;
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<Index>(uv.values.size());
      const Vec3 p = mesh.positions[t[k]];
      uv.values.push_back({p.x + (centre > 10 ? 8.25 : 0), p.y + (centre > 10 ? 3.3 : 0)});
    }
    uv.indices.push_back(corners);
  }
  MeasureOptions options;
  options.uv_per_texture = {4, 3};
  const DistortionReport r = measure_distortion(mesh, uv, options);
  EXPECT_EQ(r.charts, 2u);  // equal values are one point, however they are indexed
  EXPECT_NEAR(r.seam_length_mm, 10, 1e-12);
  EXPECT_NEAR(r.seam_phase_jump, std::hypot(0.0625, 0.1), 1e-12);  // 8.25 = 2 · 4 + 0.25, 3.3 = 3 + 0.3
}

TEST(Measure, DegenerateTrianglesAreCountedAndGiveNoNan) {
  TriangleMesh mesh = fan();
  mesh.positions.push_back({0.5, 1, 0});
  mesh.triangles.push_back({0, 5, 1});  // on the line from 0 to 1
  mesh.positions.push_back({5, 0, 0});
  mesh.triangles.push_back({0, 3, 6});
  auto uv = uv_per_vertex(mesh, [](Vec3 p) { return Vec2{p.x, p.y}; });
  uv.values[6] = uv.values[3];  // no area in uv
  const DistortionReport r = measure_distortion(mesh, uv);
  EXPECT_EQ(r.degenerate_3d, 1u);
  EXPECT_EQ(r.degenerate_uv, 1u);
  EXPECT_EQ(r.measured_triangles, 4u);
  EXPECT_TRUE(std::isfinite(r.symmetric_dirichlet.max));
  EXPECT_TRUE(std::isfinite(r.maillot_length));
}

TEST(Measure, AllPointsInOneGiveZerosNotNan) {
  TriangleMesh mesh = fan();
  const DistortionReport r = measure_distortion(mesh, uv_per_vertex(mesh, [](Vec3) { return Vec2{2, 2}; }));
  EXPECT_EQ(r.degenerate_uv, 4u);
  EXPECT_EQ(r.stretch_l2, 0);
  EXPECT_TRUE(std::isfinite(r.maillot_length));
  EXPECT_TRUE(std::isfinite(r.maillot_area));
}

TEST(Measure, PartsDoNotMeet) {
  // The same square twice, stacked in space and in uv: nothing of one part touches the other.
  TriangleMesh mesh = fan();
  mesh.triangles.insert(mesh.triangles.end(), mesh.triangles.begin(), mesh.triangles.begin() + 4);
  const auto uv = uv_per_vertex(mesh, [](Vec3 p) { return Vec2{p.x, p.y}; });
  MeasureOptions options;
  EXPECT_NEAR(measure_distortion(mesh, uv, options).overlap_area_fraction, 1, 1e-9);
  options.part = {0, 0, 0, 0, 1, 1, 1, 1};
  const DistortionReport r = measure_distortion(mesh, uv, options);
  EXPECT_EQ(r.overlap_area_fraction, 0);
  EXPECT_EQ(r.charts, 2u);
  options.part.pop_back();
  EXPECT_THROW(measure_distortion(mesh, uv, options), InvalidInput);
}

TEST(Measure, TrianglesWithoutUvAreLeftOut) {
  const TriangleMesh mesh = fan();
  auto uv = uv_per_vertex(mesh, [](Vec3 p) { return Vec2{p.x, p.y}; });
  uv.indices[1] = {k_no_value, k_no_value, k_no_value};
  const DistortionReport r = measure_distortion(mesh, uv);
  EXPECT_EQ(r.triangles, 4u);
  EXPECT_EQ(r.without_uv, 1u);
  EXPECT_EQ(r.measured_triangles, 3u);
  EXPECT_FALSE(r.per_triangle[1].measured);
  EXPECT_TRUE(r.per_triangle[2].measured);
  EXPECT_NEAR(r.symmetric_dirichlet.max, 4, 1e-12);
}

TEST(Measure, EmptyMeshIsEmpty) { EXPECT_EQ(measure_distortion({}, {}).triangles, 0u); }

TEST(Measure, RefusesWhatIsNoUv) {
  TriangleMesh mesh = fan();
  auto uv = uv_per_vertex(mesh, [](Vec3 p) { return Vec2{p.x, p.y}; });
  EXPECT_THROW(measure_distortion(mesh, {}), InvalidInput);
  auto broken = uv;
  broken.values[2].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(measure_distortion(mesh, broken), InvalidInput);
  broken = uv;
  broken.indices[1][1] = 99;
  EXPECT_THROW(measure_distortion(mesh, broken), InvalidInput);
  mesh.positions[0].x = std::numeric_limits<double>::infinity();
  EXPECT_THROW(measure_distortion(mesh, uv), InvalidInput);
  EXPECT_THROW(measure_distortion(fan(), uv, {.texture_px = {0, 1}}), InvalidInput);
}

/// Three unit squares beside one another, each a chart; the uv of square i are factors[i] times its shape.
TriangleMesh three_squares(std::array<double, 3> factors) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto x = static_cast<double>(2 * i);
    const auto first = static_cast<Index>(mesh.positions.size());
    for (const Vec2 p : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}}) {
      mesh.positions.push_back({x + p.x, p.y, 0});
      mesh.uv.values.push_back({100 * x + factors[i] * p.x, factors[i] * p.y});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  mesh.uv.indices = mesh.triangles;
  return mesh;
}

double dirichlet(double s) { return 2 * s * s + 2 / (s * s); }

DistortionReport measured(const TriangleMesh& mesh, UvNormalization normalize) {
  return measure_distortion(mesh, mesh.uv, {.normalize = normalize, .part = {0, 0, 0, 0, 7, 7}});
}

TEST(Normalize, ScaledSquaresHaveTheClosedForms) {
  const TriangleMesh mesh = three_squares({2, 3, 5});
  struct Case {
    UvNormalization normalize;
    std::array<double, 3> sigma;
  };
  const double scene = std::sqrt(3 / 38.0), part = std::sqrt(2 / 13.0);  // 38 = 2² + 3² + 5², 13 = 2² + 3²
  for (const Case& c : {Case{UvNormalization::scene, {2 * scene, 3 * scene, 5 * scene}},
                        Case{UvNormalization::part, {2 * part, 3 * part, 1}}, Case{UvNormalization::chart, {1, 1, 1}},
                        Case{UvNormalization::none, {2, 3, 5}}}) {
    const DistortionReport r = measured(mesh, c.normalize);
    double energy = 0, shrunk = 0, edges = 0, length = 0, area = 0;
    for (const double s : c.sigma) {
      energy += dirichlet(s) / 3;
      shrunk += 1 / (s * s) / 3;
      edges += (4 + std::sqrt(2.0)) * std::abs(s - 1);
      length += 4 + std::sqrt(2.0);
      area += s * s / 3;
    }
    EXPECT_EQ(r.charts, 3u);
    EXPECT_NEAR(r.symmetric_dirichlet.mean, energy, 1e-12);
    EXPECT_NEAR(r.stretch_l2, std::sqrt(shrunk), 1e-12);
    EXPECT_NEAR(r.stretch_linf, 1 / *std::min_element(c.sigma.begin(), c.sigma.end()), 1e-12);
    EXPECT_NEAR(r.area_ratio.mean, area, 1e-12);
    EXPECT_NEAR(r.edge_length_error, edges / length, 1e-12);
    EXPECT_NEAR(r.angle_error_deg.max, 0, 1e-10);
    EXPECT_NEAR(r.uv_area, 38, 1e-12);  // as it is
    for (std::size_t t = 0; t < 6; ++t) EXPECT_NEAR(r.per_triangle[t].sigma1, c.sigma[t / 2], 1e-12);
  }
  const DistortionReport by_chart = measured(mesh, UvNormalization::chart);
  EXPECT_NEAR(by_chart.uv_scale.min, 1 / 5.0, 1e-12);
  EXPECT_NEAR(by_chart.uv_scale.max, 1 / 2.0, 1e-12);
}

TEST(Normalize, FactorsOfChartsMatterOnlyToTheOthers) {
  TriangleMesh bent = test::spherical_cap(10, 1, 6, 12), scaled;
  bent.uv = uv_per_vertex(bent, [](Vec3 p) { return Vec2{p.x, p.y}; });
  TriangleMesh pair = bent;
  const auto first = static_cast<Index>(bent.positions.size());
  for (const Vec3 p : bent.positions) pair.positions.push_back(p + Vec3{100, 0, 0});
  for (const Vec2 p : bent.uv.values) pair.uv.values.push_back(p + Vec2{100, 0});
  for (const Triangle& t : bent.triangles) pair.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  for (const Triangle& t : bent.uv.indices) {
    const auto values = static_cast<Index>(bent.uv.values.size());
    pair.uv.indices.push_back({values + t[0], values + t[1], values + t[2]});
  }
  scaled = pair;
  for (std::size_t i = bent.uv.values.size(); i < scaled.uv.values.size(); ++i)
    scaled.uv.values[i] = 4 * scaled.uv.values[i];  // a power of two: no rounding
  const auto energy = [](const TriangleMesh& mesh, UvNormalization normalize) {
    return measure_distortion(mesh, mesh.uv, {.normalize = normalize}).symmetric_dirichlet.mean;
  };
  EXPECT_DOUBLE_EQ(energy(scaled, UvNormalization::chart), energy(pair, UvNormalization::chart));
  EXPECT_GT(energy(scaled, UvNormalization::scene), energy(pair, UvNormalization::scene) + 1);
  EXPECT_GT(energy(scaled, UvNormalization::none), energy(pair, UvNormalization::none) + 1);
  // One part: as the scene.
  EXPECT_EQ(energy(scaled, UvNormalization::part), energy(scaled, UvNormalization::scene));
}

}  // namespace
}  // namespace papilla
