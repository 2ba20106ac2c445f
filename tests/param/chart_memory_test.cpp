// SPDX-License-Identifier: MIT
#include "papilla/param/chart_memory.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/meshing/cut_open.hpp"
#include "papilla/param/automatic.hpp"
#include "papilla/param/best.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

/// A bumpy sheet.
TriangleMesh sheet() {
  return test::grid_mesh(16, 8, [](double s, double t) {
    return Vec3{10 * s, 5 * t, std::sin(7 * s) * std::cos(5 * t)};
  });
}

/// Charts side by side that end at these x.
ChartSet strips(const TriangleMesh& mesh, const std::vector<double>& ends) {
  ChartSet charts;
  charts.count = static_cast<std::uint32_t>(ends.size()) + 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double x = (mesh.corner(t, 0).x + mesh.corner(t, 1).x + mesh.corner(t, 2).x) / 3;
    std::uint32_t chart = 0;
    while (chart < ends.size() && x > ends[chart]) ++chart;
    charts.of_triangle.push_back(chart);
  }
  return charts;
}

Vec2 corner_uv(const Flattening& f, std::size_t t, std::size_t k) { return f.uv.values[f.uv.indices[t][k]]; }

TEST(ChartMemory, ChartsThatStayAreNotMappedAgain) {
  const TriangleMesh mesh = sheet();
  const ChartSet two = strips(mesh, {5}), three = strips(mesh, {5, 7.5});
  ChartMemory memory;
  BestOptions options;
  options.memory = &memory;
  const Flattening first = flatten_best(cut_open(mesh, two), two, options);
  BestOptions rough = options;
  rough.max_iterations = 0;
  rough.tolerance = 0.9;  // what is mapped now differs
  const Flattening second = flatten_best(cut_open(mesh, three), three, rough);
  rough.memory = nullptr;
  const Flattening alone = flatten_best(cut_open(mesh, three), three, rough);
  ASSERT_EQ(second.charts.of_triangle, three.of_triangle);
  bool differs = false;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 uv = corner_uv(second, t, k);
      EXPECT_EQ(uv, three.of_triangle[t] == 0 ? corner_uv(first, t, k) : corner_uv(alone, t, k));
      differs |= three.of_triangle[t] == 0 && uv != corner_uv(alone, t, k);
    }
  EXPECT_TRUE(differs);
}

TEST(ChartMemory, ChangesNothingElse) {
  const TriangleMesh mesh = sheet();
  ChartMemory memory;
  AutomaticOptions options;
  options.best.memory = &memory;
  for (const std::vector<double>& ends : {std::vector<double>{5}, {2.5, 5}, {2.5, 5, 7.5}}) {
    const ChartSet charts = strips(mesh, ends);
    const AutomaticResult with = flatten_automatic(cut_open(mesh, charts), charts, options);
    const AutomaticResult without = flatten_automatic(cut_open(mesh, charts), charts);
    EXPECT_EQ(with.flattening.uv.values, without.flattening.uv.values);
    EXPECT_EQ(with.flattening.uv.indices, without.flattening.uv.indices);
    EXPECT_NEAR(with.flattening.trace.back().error, without.flattening.trace.back().error, 1e-12);
    ASSERT_EQ(with.choices.size(), without.choices.size());
    for (std::size_t c = 0; c < with.choices.size(); ++c) EXPECT_EQ(with.choices[c].reason, without.choices[c].reason);
  }
}

TEST(ChartMemory, ChartsCutInAnotherWayAreMappedAnew) {
  const TriangleMesh mesh = sheet();
  ChartSet one = strips(mesh, {});
  ChartMemory memory;
  BestOptions options;
  options.memory = &memory;
  flatten_best(mesh, one, options);
  // A slit at x = 5 half across: the triangles are the same.
  const ChartSet sides = strips(mesh, {5});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = mesh.corner(t, k), b = mesh.corner(t, (k + 1) % 3);
      if (sides.of_triangle[t] == 0 && std::abs(a.x - 5) + std::abs(b.x - 5) < 1e-9 && a.y + b.y < 4)
        one.cuts.push_back(static_cast<Index>(3 * t) + static_cast<Index>(k));
    }
  const TriangleMesh slit = cut_open(mesh, one);
  one.cuts.clear();
  const Flattening with = flatten_best(slit, one, options);
  options.memory = nullptr;
  const Flattening without = flatten_best(slit, one, options);
  EXPECT_EQ(with.uv.values, without.uv.values);
  EXPECT_EQ(with.uv.indices, without.uv.indices);
  EXPECT_GT(with.uv.values.size(), mesh.positions.size());
}

}  // namespace
}  // namespace papilla
