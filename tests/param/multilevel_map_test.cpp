// SPDX-License-Identifier: MIT
#include "multilevel_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "disk_chart.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// The whole mesh, of area 1.
ChartSurface chart_of(const TriangleMesh& mesh) {
  ChartSurface chart;
  chart.positions = mesh.positions;
  chart.triangles = mesh.triangles;
  return to_unit(chart).surface;
}

/// How many vertices the levels of a map have, coarse to fine: progress is half their part of all, until the last one.
std::vector<double> levels_of(const TriangleMesh& mesh) {
  const ChartSurface chart = chart_of(mesh);
  const auto all = static_cast<double>(mesh.positions.size());
  std::vector<double> levels;
  MultilevelOptions options;
  options.progress = [&](double fraction) {
    if (fraction <= 0.5) levels.push_back(2 * fraction * all);
  };
  EXPECT_EQ(map_multilevel(chart, options).failure, "");
  levels.push_back(all);
  return levels;
}

TEST(MultilevelMap, LargeChartsEndWithFullSteps) {
  // 22,321 vertices: with six times as many from the 24 coarsest on, the step before the last one would end at 5,184.
  for (const TriangleMesh& mesh : {test::dashboard_mesh(220, 100), test::dashboard_mesh(374, 134)}) {
    const std::vector<double> levels = levels_of(mesh);
    ASSERT_GE(levels.size(), 5u);
    for (std::size_t i = levels.size() - 1; i > 1; --i) EXPECT_NEAR(levels[i] / 6, levels[i - 1], 1);
    EXPECT_GE(levels[1], 1.5 * levels[0]);
    EXPECT_LE(levels[1], 9 * levels[0]);
  }
}

TEST(MultilevelMap, SmallChartsBeginWithFullSteps) {
  const std::vector<double> levels = levels_of(test::dashboard_mesh(70, 40));  // 2,911 vertices
  ASSERT_EQ(levels.size(), 4u);
  EXPECT_NEAR(levels[1], 6 * levels[0], 1e-6);
  EXPECT_NEAR(levels[2], 6 * levels[1], 1e-6);
}

TEST(MultilevelMap, LargeChartsComeNearTheirMinimum) {
  // Bumps of 11 cells across, on 21,091 vertices.
  const ChartSurface chart = chart_of(test::grid_mesh(160, 130, [](double s, double t) {
    const double wave = std::sin(98 * s) * std::cos(70 * t) + 0.3 * std::sin(37.8 * (s + t));
    return Vec3{1000 * s, 700 * t, 30 * wave};
  }));
  MultilevelOptions exact;
  exact.tolerance = 1e-7;
  const double least = map_multilevel(chart, exact).trace.back().error;
  EXPECT_NEAR(least, 4.71664, 1e-4);
  EXPECT_LT(map_multilevel(chart, {}).trace.back().error - least, 2.5e-4);
}

}  // namespace
}  // namespace papilla
