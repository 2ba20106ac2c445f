// SPDX-License-Identifier: MIT
#include "papilla/param/automatic.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

std::string method_of(const TriangleMesh& mesh, double most_energy) {
  const AutomaticResult r = flatten_automatic(mesh, test::one_chart(mesh));
  EXPECT_TRUE(r.flattening.notes.empty());
  EXPECT_EQ(r.choices.size(), 1u);
  EXPECT_FALSE(r.choices[0].reason.empty());
  const DistortionReport d = measure_distortion(mesh, r.flattening.uv);
  EXPECT_EQ(d.flipped, 0u);
  EXPECT_EQ(d.overlap_within_charts, 0);
  EXPECT_LE(d.symmetric_dirichlet.mean, most_energy);
  EXPECT_NEAR(r.flattening.trace.back().error, d.symmetric_dirichlet.mean, 1e-3);
  return r.choices[0].method;
}

TEST(Automatic, DevelopableChartsAreExact) {
  EXPECT_EQ(method_of(test::grid_mesh(64, 30, test::open_cylinder), 4 + 1e-9), "exact");
  EXPECT_EQ(method_of(test::plane(4, 3, 8, 6), 4 + 1e-9), "exact");
}

TEST(Automatic, NearlyFlatChartsAreProjected) {
  TriangleMesh mesh = test::plane(100, 60, 20, 12);
  for (Vec3& p : mesh.positions) p.z = 0.8 * std::sin(p.x / 7) * std::sin(p.y / 7);
  EXPECT_EQ(method_of(mesh, 4.001), "planar");
}

TEST(Automatic, CurvedChartsAreMappedBest) {
  EXPECT_EQ(method_of(test::dashboard_mesh(60, 21), 4.01), "best");
  // Each vertex of a fine dome misses little, all of them much.
  EXPECT_EQ(method_of(test::spherical_cap(10, 1.2, 200, 60), 4.2), "best");
}

TEST(Automatic, WhatOverlapsWhenItIsExactIsMappedBest) {
  EXPECT_EQ(method_of(test::grid_mesh(60, 6, test::helical_ramp), 5), "best");
}

TEST(Automatic, EveryChartHasAChoice) {
  TriangleMesh cube = test::cube(5);
  ChartSet charts;
  for (std::uint32_t t = 0; t < cube.triangles.size(); ++t) charts.of_triangle.push_back(t / 2);
  charts.count = 6;
  const AutomaticResult r = flatten_automatic(cube, charts);
  ASSERT_EQ(r.choices.size(), 6u);
  for (std::uint32_t c = 0; c < 6; ++c) EXPECT_EQ(r.choices[c].chart, c);
}

TEST(Automatic, BadInputIsNamed) {
  const TriangleMesh mesh = test::plane(2, 2, 2, 2);
  AutomaticOptions options;
  options.flat_deg = 61;
  EXPECT_THROW(flatten_automatic(mesh, test::one_chart(mesh), options), InvalidInput);
  options = {};
  options.developable_deg = -1;
  EXPECT_THROW(flatten_automatic(mesh, test::one_chart(mesh), options), InvalidInput);
  options = {};
  options.best.tolerance = 2;
  EXPECT_THROW(flatten_automatic(mesh, test::one_chart(mesh), options), InvalidInput);
  EXPECT_TRUE(flatten_automatic({}, {}).choices.empty());
}

}  // namespace
}  // namespace papilla
