// SPDX-License-Identifier: MIT
#include "papilla/param/reference_maps.hpp"

#include <gtest/gtest.h>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

TEST(ReferenceMaps, ArapIsExactOnDevelopables) {
  const TriangleMesh mesh = test::grid_mesh(32, 16, test::open_cylinder);
  const Flattening f = flatten_reference(mesh, test::one_chart(mesh));
  EXPECT_TRUE(f.notes.empty());
  EXPECT_NEAR(measure_distortion(mesh, f.uv).symmetric_dirichlet.mean, 4, 1e-4);
}

TEST(ReferenceMaps, FixedBordersAreCircles) {
  const TriangleMesh mesh = test::dashboard_mesh(20, 8);
  for (const ReferenceMap map : {ReferenceMap::tutte, ReferenceMap::mean_value}) {
    ReferenceOptions options;
    options.map = map;
    const Flattening f = flatten_reference(mesh, test::one_chart(mesh), options);
    EXPECT_TRUE(f.notes.empty());
    const DistortionReport r = measure_distortion(mesh, f.uv);
    EXPECT_EQ(r.flipped, 0u);
    EXPECT_NEAR(f.trace.front().error, r.symmetric_dirichlet.mean, 1e-6 * r.symmetric_dirichlet.mean);
  }
}

TEST(ReferenceMaps, FlippedTrianglesDoNotSendAChartToProjection) {
  // ARAP folds nearly closed spheres.
  const TriangleMesh mesh = test::spherical_cap(10, 2.9, 16, 24);
  const Flattening f = flatten_reference(mesh, test::one_chart(mesh));
  EXPECT_EQ(f.charts.count, 1u);
  const DistortionReport r = measure_distortion(mesh, f.uv);
  EXPECT_EQ(r.flipped, 0u);
  EXPECT_EQ(r.overlap_within_charts, 0);
  if (!f.notes.empty()) {
    EXPECT_NE(f.notes[0].reason.find("least distortion"), std::string::npos) << f.notes[0].reason;
  }
}

TEST(ReferenceMaps, BadInputIsNamed) {
  const TriangleMesh mesh = test::plane(2, 2, 2, 2);
  ReferenceOptions options;
  options.arap_lambda = -1;
  EXPECT_THROW(flatten_reference(mesh, test::one_chart(mesh), options), InvalidInput);
  options = {};
  options.arap_iterations = 0;
  EXPECT_THROW(flatten_reference(mesh, test::one_chart(mesh), options), InvalidInput);
}

}  // namespace
}  // namespace papilla
