// SPDX-License-Identifier: MIT
#include "papilla/param/maillot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

TEST(Maillot, DevelopableChartHasNoEnergy) {
  const TriangleMesh mesh = test::grid_mesh(32, 16, test::open_cylinder);
  const MaillotResult r = flatten_maillot(mesh, test::one_chart(mesh));
  EXPECT_LT(r.length_energy, 1e-9 * r.squared_edges);
  EXPECT_LT(r.area_energy, 1e-9 * r.squared_edges);
  EXPECT_NEAR(measure_distortion(mesh, r.flattening.uv).symmetric_dirichlet.mean, 4, 1e-6);
}

TEST(Maillot, EnergiesAreThoseOfTheReferee) {
  // The referee scales to equal area first, so compare on a map that has it: φ small keeps areas almost exactly.
  const TriangleMesh mesh = test::dashboard_mesh(40, 16);
  MaillotOptions options;
  options.length_weight = 0.001;
  options.tolerance = 1e-9;
  const MaillotResult r = flatten_maillot(mesh, test::one_chart(mesh), options);
  const DistortionReport referee = measure_distortion(mesh, r.flattening.uv);
  EXPECT_NEAR(r.length_energy / r.squared_edges, referee.maillot_length, 0.02 * referee.maillot_length);
  EXPECT_NEAR(r.area_energy, referee.maillot_area * 2 * referee.area_mm2, 0.1 * r.area_energy + 1e-6);
}

TEST(Maillot, LowersLengthEnergyBelowTheStart) {
  const TriangleMesh mesh = test::dashboard_mesh(60, 21);
  const MaillotResult r = flatten_maillot(mesh, test::one_chart(mesh));
  EXPECT_TRUE(r.flattening.notes.empty());
  const DistortionReport d = measure_distortion(mesh, r.flattening.uv);
  EXPECT_EQ(d.flipped, 0u);
  EXPECT_EQ(d.overlap_within_charts, 0);
  EXPECT_LT(d.maillot_length, 0.0026);
  EXPECT_LT(d.symmetric_dirichlet.mean, 4.012);
  const Trace& trace = r.flattening.trace;
  for (std::size_t i = 1; i < trace.size(); ++i) EXPECT_LE(trace[i].error, trace[i - 1].error);
  EXPECT_NEAR(trace.back().error, 0.5 * (r.length_energy + r.area_energy), 1e-6 * trace.back().error);
}

TEST(Maillot, AreasAloneAreReachedAndThatEndsIt) {
  // Every disk has maps that keep areas: the energy falls to nothing, by a large part of itself in each step.
  const TriangleMesh mesh = test::hemisphere_mesh(25, 50);
  MaillotOptions options;
  options.length_weight = 0;
  options.distortion_limit = 0;
  const MaillotResult r = flatten_maillot(mesh, test::one_chart(mesh), options);
  EXPECT_EQ(r.flattening.stop, StopReason::converged);
  EXPECT_LT(r.flattening.trace.size(), 12u);
  const double area = measure_distortion(mesh, r.flattening.uv).area_mm2;
  EXPECT_LT(r.area_energy, 2e-12 * area);
  EXPECT_GT(r.length_energy, 1e-3 * r.squared_edges);
}

TEST(Maillot, BothSolversFindTheSameMinimum) {
  const TriangleMesh mesh = test::spherical_cap(10, 0.7, 5, 12);
  MaillotOptions options;
  options.distortion_limit = 0;
  options.tolerance = 1e-13;
  options.max_iterations = 20000;
  const MaillotResult fast = flatten_maillot(mesh, test::one_chart(mesh), options);
  options.solver = MaillotSolver::gradient_descent;
  options.tolerance = 1e-10;
  const MaillotResult slow = flatten_maillot(mesh, test::one_chart(mesh), options);
  EXPECT_EQ(fast.flattening.trace.front().error, slow.flattening.trace.front().error);
  EXPECT_NEAR(fast.flattening.trace.back().error, slow.flattening.trace.back().error,
              1e-5 * fast.flattening.trace.back().error);
  EXPECT_LT(fast.flattening.trace.size(), slow.flattening.trace.size());
}

TEST(Maillot, WeightTradesLengthsForAreas) {
  const TriangleMesh mesh = test::spherical_cap(10, 1.2, 8, 24);
  MaillotOptions options;
  options.distortion_limit = 0;
  double length_before = 1e300, area_before = -1;
  for (const double phi : {0.0, 0.1, 0.5, 0.9}) {
    options.length_weight = phi;
    options.tolerance = 1e-9;
    const MaillotResult r = flatten_maillot(mesh, test::one_chart(mesh), options);
    EXPECT_LE(r.length_energy, length_before);
    EXPECT_GE(r.area_energy, area_before);
    length_before = r.length_energy, area_before = r.area_energy;
  }
}

TEST(Maillot, DistortionLimitHolds) {
  const TriangleMesh mesh = test::hemisphere_mesh(20, 40);
  MaillotOptions options;
  options.max_iterations = 0;
  const double start = measure_distortion(mesh, flatten_maillot(mesh, test::one_chart(mesh), options).flattening.uv)
                           .symmetric_dirichlet.mean;
  options.max_iterations = 100;
  options.distortion_limit = 1.01;
  const MaillotResult r = flatten_maillot(mesh, test::one_chart(mesh), options);
  EXPECT_EQ(r.flattening.stop, StopReason::line_search_stalled);
  const double end = measure_distortion(mesh, r.flattening.uv).symmetric_dirichlet.mean;
  EXPECT_LE(end, 1.0101 * start);
  EXPECT_GT(end, 1.005 * start);
}

TEST(Maillot, PureLengthsFoldCurvedChartsWhenTheyMay) {
  const TriangleMesh mesh = test::spherical_cap(10, 2.4, 12, 24);
  MaillotOptions options;
  options.length_weight = 1;
  options.allow_flips = true;
  options.tolerance = 1e-6;
  const MaillotResult folded = flatten_maillot(mesh, test::one_chart(mesh), options);
  EXPECT_GT(folded.flipped, 0u);
  EXPECT_EQ(folded.invalid_charts, 1u);
  EXPECT_EQ(measure_distortion(mesh, folded.flattening.uv).flipped, folded.flipped);
  options.allow_flips = false;
  const MaillotResult valid = flatten_maillot(mesh, test::one_chart(mesh), options);
  EXPECT_EQ(valid.flipped, 0u);
  EXPECT_EQ(measure_distortion(mesh, valid.flattening.uv).flipped, 0u);
}

TEST(Maillot, ConformalStart) {
  const TriangleMesh mesh = test::dashboard_mesh(40, 16);
  MaillotOptions options;
  options.start = MaillotStart::conformal;
  options.distortion_limit = 0;
  options.tolerance = 1e-9;
  const double from_conformal = flatten_maillot(mesh, test::one_chart(mesh), options).length_energy;
  options.start = MaillotStart::coarse_to_fine;
  EXPECT_NEAR(flatten_maillot(mesh, test::one_chart(mesh), options).length_energy, from_conformal,
              1e-3 * from_conformal);
}

TEST(Maillot, PlanarStartHasTheEnergyOfTheProjection) {
  // A paraboloid's shallow cap over a square: uv of the start are x and y, so that E follows from lengths and areas.
  TriangleMesh mesh = test::plane(20, 20, 10, 10);
  for (Vec3& p : mesh.positions) p.z = 0.02 * ((p.x - 10) * (p.x - 10) + (p.y - 10) * (p.y - 10));
  double length = 0, area = 0;
  std::map<std::pair<Index, Index>, bool> seen;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!seen.try_emplace(std::minmax(t[k], t[(k + 1) % 3])).second) continue;
      const Vec3 e = mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]];
      length += e.z * e.z * e.z * e.z / dot(e, e);
    }
    const Vec3 n = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    area += (n.z - norm(n)) * (n.z - norm(n)) / norm(n);
  }
  MaillotOptions options = maillot_as_written(MaillotStart::planar, 0.25);
  options.max_iterations = 0;
  const MaillotResult start = flatten_maillot(mesh, test::one_chart(mesh), options);
  EXPECT_NEAR(start.start_energy, 0.25 * length + 0.75 * area, 1e-9 * start.start_energy);
  EXPECT_EQ(start.end_energy, start.start_energy);
  options.max_iterations = 500;
  const MaillotResult r = flatten_maillot(mesh, test::one_chart(mesh), options);
  EXPECT_EQ(r.start_energy, start.start_energy);
  EXPECT_LT(r.end_energy, 0.5 * r.start_energy);
  EXPECT_NEAR(r.end_energy, 0.25 * r.length_energy + 0.75 * r.area_energy, 1e-6 * r.end_energy);
  ASSERT_EQ(r.choices.size(), 1u);
  EXPECT_TRUE(r.choices.front().reason.starts_with("from the planar map: E ")) << r.choices.front().reason;
}

TEST(Maillot, AsWrittenFindsTheMinimumFromBothStarts) {
  const TriangleMesh mesh = test::spherical_cap(10, 0.7, 5, 12);
  MaillotOptions fast;
  fast.distortion_limit = 0;
  fast.tolerance = 1e-12;
  const double least = flatten_maillot(mesh, test::one_chart(mesh), fast).end_energy;
  std::vector<double> starts;
  for (const MaillotStart start : {MaillotStart::conformal, MaillotStart::planar}) {
    MaillotOptions options = maillot_as_written(start);
    options.tolerance = 1e-9;
    options.max_iterations = 20000;
    const MaillotResult r = flatten_maillot(mesh, test::one_chart(mesh), options);
    EXPECT_NEAR(r.end_energy, least, 1e-4 * least);
    starts.push_back(r.start_energy);
  }
  EXPECT_GT(std::abs(starts[0] - starts[1]), 0.01 * starts[0]);
}

TEST(Maillot, SaysWhereAStartIsNoMap) {
  // Beyond half a sphere the projection turns triangles over.
  const TriangleMesh mesh = test::spherical_cap(10, 2.2, 10, 24);
  MaillotOptions options;
  options.start = MaillotStart::planar;
  const MaillotResult valid = flatten_maillot(mesh, test::one_chart(mesh), options);
  ASSERT_EQ(valid.choices.size(), 1u);
  EXPECT_TRUE(valid.choices.front().reason.starts_with("from coarse to fine, as the planar map is none ("))
      << valid.choices.front().reason;
  EXPECT_EQ(valid.flipped, 0u);
  options = maillot_as_written(MaillotStart::planar);
  options.max_iterations = 0;
  const MaillotResult literal = flatten_maillot(mesh, test::one_chart(mesh), options);
  EXPECT_TRUE(literal.choices.front().reason.starts_with("from the planar map: E ")) << literal.choices.front().reason;
  EXPECT_GT(literal.flipped, 0u);
}

TEST(Maillot, BadInputIsNamed) {
  const TriangleMesh mesh = test::plane(2, 2, 2, 2);
  for (const double phi : {-0.1, 1.1, std::nan("")}) {
    MaillotOptions options;
    options.length_weight = phi;
    EXPECT_THROW(flatten_maillot(mesh, test::one_chart(mesh), options), InvalidInput);
  }
  MaillotOptions options;
  options.distortion_limit = 0.5;
  EXPECT_THROW(flatten_maillot(mesh, test::one_chart(mesh), options), InvalidInput);
  EXPECT_TRUE(flatten_maillot({}, {}).flattening.uv.empty());
}

}  // namespace
}  // namespace papilla
