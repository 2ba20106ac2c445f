// SPDX-License-Identifier: MIT
#include "papilla/param/bounded_seams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
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

TEST(BoundedSeams, WhereNothingComesOfACoarseMeshTheNextIsSearched) {
  const TriangleMesh mesh = test::plane(40, 10, 8, 4), first = test::plane(40, 10, 4, 2);
  int maps = 0, maps_of_first = 0, maps_of_next = 0;
  SeamTools tools = plate_tools(mesh, maps);
  CoarseSurface of_first{first, {}, plate_tools(first, maps_of_first)};
  // Its vertices lie where others of the fine mesh do.
  std::vector<Index> places;
  for (const Vec3& p : first.positions)
    for (Index v = 0; v < mesh.positions.size(); ++v)
      if (norm(mesh.positions[v] - p) < 1e-9) places.push_back(v);
  ASSERT_EQ(places.size(), first.positions.size());
  of_first.vertices = places;
  std::vector<Index> all(mesh.positions.size());  // The next coarse mesh is the fine one.
  std::iota(all.begin(), all.end(), Index{0});
  CoarseSurface next{mesh, all, plate_tools(mesh, maps_of_next)};
  std::vector<std::size_t> asked;
  tools.coarse = [&](std::size_t attempt) -> const CoarseSurface* {
    asked.push_back(attempt);
    return attempt == 0 ? &of_first : attempt == 1 ? &next : nullptr;
  };
  BoundedSeams result = keep_bound(mesh, {4.1, {}}, tools);
  EXPECT_TRUE(result.kept);
  EXPECT_EQ(result.seam_mm, 0);
  EXPECT_EQ(std::count(asked.begin(), asked.end(), 1u), 0) << "the first one was good";
  EXPECT_EQ(maps_of_next, 0);

  // No chart may be the whole plate, and none may end in its middle, where the first coarse mesh has its cut.
  asked.clear();
  const auto stretched = [](SeamTools& of, const TriangleMesh& on, bool in_the_middle, bool is_fine) {
    const auto map = of.map;
    of.map = [=, &on](const ChartSet& charts, double most_excess_mm2, const CornerAttribute<Vec2>* nearby) {
      ChartedMap charted = map(charts, most_excess_mm2, nearby);
      double most = 0;
      for (std::size_t t = 0; t < on.triangles.size(); ++t)
        if (charts.of_triangle[t] == charts.of_triangle[0])
          for (const Index v : on.triangles[t]) most = std::max(most, on.positions[v].x);
      if (charts.count == 1 || (is_fine && most == 20))
        for (Vec2& p : charted.flattening.uv.values) p.y *= 3;
      return charted;
    };
    const auto chart = of.chart;
    of.chart = [chart, in_the_middle](double seam_cost, bool) { return chart(seam_cost, in_the_middle); };
  };
  stretched(tools, mesh, false, true);
  stretched(of_first.tools, first, true, false);
  stretched(next.tools, mesh, false, false);
  result = keep_bound(mesh, {4.1, {}}, tools);
  EXPECT_TRUE(result.kept);
  EXPECT_EQ(result.charted.flattening.charts.count, 2u);
  EXPECT_EQ(result.distortion, 4);
  EXPECT_EQ(std::count(asked.begin(), asked.end(), 1u), 1);
  EXPECT_GT(maps_of_next, 0);
  EXPECT_EQ(std::count(asked.begin(), asked.end(), 2u), 0) << "the next one was good";
}

TEST(BoundedSeams, ABriefSearchBeginsWithLess) {
  const TriangleMesh mesh = test::plane(40, 10, 8, 4);
  int maps = 0, brief_maps = 0;
  const auto kept_by = [&](bool brief, int& count) {
    SeamTools tools = plate_tools(mesh, count);
    tools.brief = brief;
    // One more cut where seams cost little: all keep the bound.
    const auto map = tools.map;
    tools.chart = [&mesh, map](double seam_cost, bool) {
      ChartSet charts;
      charts.count = seam_cost < 0.01 ? 3 : 2;
      for (const Triangle& t : mesh.triangles) {
        const double x = (mesh.positions[t[0]].x + mesh.positions[t[1]].x + mesh.positions[t[2]].x) / 3;
        charts.of_triangle.push_back((x > 20) + (charts.count == 3 && x > 30));
      }
      return map(charts, 0, nullptr);
    };
    return keep_bound(mesh, {4.1, {}}, tools);
  };
  const BoundedSeams thorough = kept_by(false, maps), brief = kept_by(true, brief_maps);
  EXPECT_TRUE(thorough.kept);
  EXPECT_TRUE(brief.kept);
  EXPECT_EQ(brief.seam_mm, 0);
  EXPECT_LT(brief_maps, maps);
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
