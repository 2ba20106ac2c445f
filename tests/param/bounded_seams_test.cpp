// SPDX-License-Identifier: MIT
#include "papilla/param/bounded_seams.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

TEST(BoundedSeams, TheMeanIsByArea) {
  // A strip of 40 x 10 whose left 10 are stretched by 2 along y, whose other 30 by 1.
  TriangleMesh mesh = test::plane(40, 10, 4, 1);
  CornerAttribute<Vec2> uv{{}, mesh.uv.indices};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.positions[mesh.triangles[t][k]];
      double middle = 0;
      for (const Index v : mesh.triangles[t]) middle += mesh.positions[v].x / 3;
      uv.indices[t][k] = static_cast<Index>(uv.values.size());
      uv.values.push_back({p.x, (middle < 10 ? 2 : 1) * p.y});
    }
  const double stretched = 2 + 4 + 0.25;
  EXPECT_NEAR(bounded_distortion(mesh, uv, {}), 0.25 * stretched + 0.75 * 4, 1e-12);
  EXPECT_NEAR(bounded_distortion(mesh, uv, {4.1, 75}), 4, 1e-12);
  EXPECT_NEAR(bounded_distortion(mesh, uv, {4.1, 75.1}), stretched, 1e-12);
  EXPECT_NEAR(bounded_distortion(mesh, uv, {4.1, 100}), stretched, 1e-12);
  for (Vec2& p : uv.values) p.x = -p.x;
  EXPECT_EQ(bounded_distortion(mesh, uv, {}), std::numeric_limits<double>::infinity());
  uv.indices.pop_back();
  EXPECT_THROW(bounded_distortion(mesh, uv, {}), InvalidInput);
}

/// Tools for a flat plate: `cuts` decides whether it is cut in two, which it need not be.
/// Along features the cut is in the middle, else at three quarters of the left half.
SeamTools plate_tools(const TriangleMesh& mesh, int& maps) {
  const auto map = [&mesh, &maps](const ChartSet& charts) {
    ++maps;
    ChartedMap charted;
    Flattening& f = charted.flattening;
    f.charts = charts;
    f.uv.indices = mesh.triangles;
    for (const Vec3& p : mesh.positions) f.uv.values.push_back({p.x, p.y});
    if (charts.count > 1) {
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (charts.of_triangle[t] > 0)
          for (Index& v : f.uv.indices[t]) v += static_cast<Index>(mesh.positions.size());
      for (const Vec3& p : mesh.positions) f.uv.values.push_back({100 - p.y, p.x + 7});
    }
    return charted;
  };
  SeamTools tools;
  tools.map = [map](const ChartSet& charts, double, const CornerAttribute<Vec2>*) { return map(charts); };
  tools.chart = [&mesh, map](double, bool along_features) {
    ChartSet charts;
    charts.count = 2;
    const double cut = along_features ? 20 : 15;
    for (const Triangle& t : mesh.triangles)
      charts.of_triangle.push_back(mesh.positions[t[0]].x + mesh.positions[t[1]].x + mesh.positions[t[2]].x > 3 * cut);
    return map(charts);
  };
  tools.halve = [](const ChartSet& charts, std::span<const std::uint32_t>) { return charts; };
  tools.seam_costs.assign(3 * mesh.triangles.size(), 1);
  return tools;
}

TEST(BoundedSeams, ChartsThatFitAreJoined) {
  const TriangleMesh mesh = test::plane(40, 10, 8, 4);
  int maps = 0;
  const BoundedSeams result = keep_bound(mesh, {4, {}}, plate_tools(mesh, maps));
  EXPECT_TRUE(result.kept);
  EXPECT_EQ(result.charted.flattening.charts.count, 1u);
  EXPECT_EQ(result.seam_mm, 0);
  EXPECT_EQ(result.seam_cost_mm, 0);
  EXPECT_EQ(result.trace.size(), static_cast<std::size_t>(maps));
  EXPECT_NEAR(result.trace.front().seam_mm, 10, 1e-12);
}

TEST(BoundedSeams, WhatBrokeTheBoundIsNotMappedAgain) {
  const TriangleMesh mesh = test::plane(40, 10, 8, 6);
  int maps = 0;
  SeamTools tools = plate_tools(mesh, maps);  // Of two cuts: without, both leave the same.
  const auto map = tools.map;
  std::vector<ChartSet> tried;
  tools.map = [&](const ChartSet& charts, double most_excess_mm2, const CornerAttribute<Vec2>* nearby) {
    if (std::isfinite(most_excess_mm2)) {  // Else its uv are needed, too.
      EXPECT_NEAR(most_excess_mm2, 0.05 * 400, 1e-3);
      for (const ChartSet& before : tried)
        EXPECT_FALSE(before.of_triangle == charts.of_triangle && before.cuts == charts.cuts);
      tried.push_back(charts);
    }
    ChartedMap charted = map(charts, most_excess_mm2, nearby);
    if (charts.count == 1)
      for (Vec2& p : charted.flattening.uv.values) p.y *= 2;
    return charted;
  };
  const BoundedSeams result = keep_bound(mesh, {4.05, {}}, tools);
  EXPECT_FALSE(tried.empty());
  EXPECT_TRUE(result.kept);
  EXPECT_EQ(result.charted.flattening.charts.count, 2u);
  EXPECT_EQ(result.distortion, 4);
}

TEST(BoundedSeams, WhatCantBeIsRefused) {
  const TriangleMesh mesh = test::plane(40, 10, 8, 4);
  int maps = 0;
  SeamTools tools = plate_tools(mesh, maps);
  for (const DistortionBound& bad : {DistortionBound{3.9, {}}, DistortionBound{std::nan(""), {}},
                                     DistortionBound{4.1, 0.0}, DistortionBound{4.1, 100.5}})
    EXPECT_THROW(keep_bound(mesh, bad, tools), InvalidInput);
  tools.seam_costs.pop_back();
  EXPECT_THROW(keep_bound(mesh, {}, tools), InvalidInput);
  EXPECT_EQ(maps, 0);
}

}  // namespace
}  // namespace papilla
