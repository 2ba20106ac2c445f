// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "adjacency.hpp"
#include "border_guard.hpp"
#include "drawn_seams.hpp"
#include "mend_map.hpp"
#include "nearby_map.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/param/automatic.hpp"
#include "papilla/param/best.hpp"
#include "papilla/param/measure.hpp"
#include "papilla_test/shapes.hpp"
#include "place_rigidly.hpp"
#include "sheet_overlap.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr double k_pi = std::numbers::pi;

/// Energies are compared at minima.
BestOptions exact() {
  BestOptions options;
  options.tolerance = 1e-9;
  return options;
}

/// A bowl, and a slit in it along y = 0 from the border to some way from the pole.
struct Bowl {
  TriangleMesh mesh = test::hemisphere_mesh(20, 48, 100);
  ChartSet whole = test::one_chart(mesh);
  ChartSet slit(double least_x) const {
    const auto on_slit = [&](Vec3 p) { return std::abs(p.y) < 1e-6 && p.x > least_x; };
    ChartSet charts = test::one_chart(mesh);
    for (Index h = 0; h < 3 * mesh.triangles.size(); ++h) {
      const Triangle& t = mesh.triangles[h / 3];
      const Vec3 a = mesh.positions[t[h % 3]], b = mesh.positions[t[(h % 3 + 1) % 3]];
      if (on_slit(a) && on_slit(b) && a.x < b.x) charts.cuts.push_back(h);
    }
    EXPECT_FALSE(charts.cuts.empty());
    return charts;
  }
};

Flattening flatten(const TriangleMesh& mesh, const ChartSet& charts, const BestOptions& options) {
  Flattening f = flatten_best(cut_open(mesh, charts), charts, options);
  EXPECT_TRUE(f.notes.empty());
  const DistortionReport r = measure_distortion(cut_open(mesh, charts), f.uv);
  EXPECT_EQ(r.flipped, 0u);
  EXPECT_EQ(r.overlap_within_charts, 0);
  return f;
}

/// Each chart somewhere else, and turned by another angle.
void scatter(const ChartSet& charts, CornerAttribute<Vec2>& uv) {
  std::vector<std::uint32_t> chart(uv.values.size(), 0);
  for (std::size_t t = 0; t < uv.indices.size(); ++t)
    for (const Index v : uv.indices[t]) chart[v] = charts.of_triangle[t];
  for (std::size_t v = 0; v < uv.values.size(); ++v) {
    const double angle = 1.1 * chart[v];
    uv.values[v] = turned(uv.values[v], {std::cos(angle), std::sin(angle)}) + Vec2{1000.0 * chart[v], 0};
  }
}

/// From the map of one cut to that of another: the same minimum as from nothing, in fewer steps.
void expect_same_minimum(const TriangleMesh& mesh, const ChartSet& from, const ChartSet& to) {
  BestOptions options = exact();
  Flattening before = flatten(mesh, from, options);
  const Flattening cold = flatten(mesh, to, options);
  scatter(from, before.uv);
  options.nearby = &before.uv;
  const Flattening warm = flatten(mesh, to, options);
  const double energy = cold.trace.back().error;
  EXPECT_NEAR(warm.trace.back().error, energy, 1e-5 * energy);
  EXPECT_NE(warm.uv.values, cold.uv.values) << "it began elsewhere";
  EXPECT_LT(warm.trace.front().error, 1.3 * energy) << "it began nearby";
}

TEST(Nearby, ASlitIsOpened) {
  const Bowl bowl;
  expect_same_minimum(bowl.mesh, bowl.whole, bowl.slit(50));
  expect_same_minimum(bowl.mesh, bowl.slit(60), bowl.slit(30));
}

TEST(Nearby, ASlitIsClosed) {
  const Bowl bowl;
  expect_same_minimum(bowl.mesh, bowl.slit(70), bowl.whole);
  expect_same_minimum(bowl.mesh, bowl.slit(30), bowl.slit(50));
}

TEST(Nearby, ChartsAreJoined) {
  // Three strips of a dashboard, mapped each in its own place.
  const TriangleMesh mesh = test::dashboard_mesh(28, 12);
  ChartSet strips;
  strips.count = 3;
  for (const Triangle& t : mesh.triangles) {
    double x = 0;
    for (const Index v : t) x += mesh.positions[v].x / 3;
    strips.of_triangle.push_back(x < 400 ? 0 : x < 900 ? 1 : 2);
  }
  expect_same_minimum(mesh, strips, test::one_chart(mesh));
}

TEST(Nearby, TrianglesThatDoNotHangTogetherAreJoined) {
  // Of the map of a bowl with a slit, each triangle a little turned.
  const Bowl bowl;
  BestOptions options = exact();
  const Flattening open = flatten(bowl.mesh, bowl.slit(50), options);
  CornerAttribute<Vec2> apart;
  for (std::size_t t = 0; t < open.uv.indices.size(); ++t) {
    const Vec2 origin = open.uv.values[open.uv.indices[t][0]];
    const double angle = 0.2 * std::sin(7.0 * static_cast<double>(t));
    const auto first = static_cast<Index>(apart.values.size());
    for (const Index v : open.uv.indices[t])
      apart.values.push_back(origin + turned(open.uv.values[v] - origin, {std::cos(angle), std::sin(angle)}));
    apart.indices.push_back({first, first + 1, first + 2});
  }
  options.nearby = &apart;
  const Flattening joined = flatten(bowl.mesh, bowl.slit(50), options);
  const double energy = open.trace.back().error;
  EXPECT_NEAR(joined.trace.back().error, energy, 1e-5 * energy);
  EXPECT_LT(joined.trace.front().error, 1.1 * energy) << "it began nearby";
  EXPECT_NE(joined.uv.values, open.uv.values);
}

TEST(Nearby, WhatIsNotNearbyIsOfNoConsequence) {
  const Bowl bowl;
  const Flattening cold = flatten_best(bowl.mesh, bowl.whole);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-100, 100);
  CornerAttribute<Vec2> uv{{}, bowl.mesh.triangles};
  for (std::size_t v = 0; v < bowl.mesh.positions.size(); ++v) uv.values.push_back({any(random), any(random)});
  BestOptions options;
  options.nearby = &uv;
  EXPECT_EQ(flatten_best(bowl.mesh, bowl.whole, options).uv.values, cold.uv.values);
  for (Vec2& p : uv.values) p = {0, 0};
  EXPECT_EQ(flatten_best(bowl.mesh, bowl.whole, options).uv.values, cold.uv.values);
}

TEST(Nearby, AMapOfAnotherMeshIsRefused) {
  const Bowl bowl;
  const Flattening map = flatten_best(bowl.mesh, bowl.whole);
  const auto expect_refused = [&](const CornerAttribute<Vec2>& uv) {
    BestOptions options;
    options.nearby = &uv;
    EXPECT_THROW(flatten_best(bowl.mesh, bowl.whole, options), InvalidInput);
    EXPECT_THROW(flatten_automatic(bowl.mesh, bowl.whole, {.best = options}), InvalidInput);
  };
  CornerAttribute<Vec2> uv = map.uv;
  uv.indices.pop_back();
  expect_refused(uv);
  uv = map.uv;
  uv.indices[5][1] = static_cast<Index>(uv.values.size());
  expect_refused(uv);
  uv = map.uv;
  uv.values[7].y = std::numeric_limits<double>::quiet_NaN();
  expect_refused(uv);
}

TEST(Nearby, WhatIsOfNoUseIsLeftUnfinishedHereToo) {
  const Bowl bowl;
  const ChartSet slit = bowl.slit(30);
  BestOptions options = exact();
  const Flattening open = flatten(bowl.mesh, slit, options), whole = flatten(bowl.mesh, bowl.whole, options);
  options.nearby = &open.uv;
  ChartMemory memory;
  options.memory = &memory;
  const double area = 2 * k_pi * 100 * 100, excess = (whole.trace.back().error - 4) * area;
  options.give_up_excess_mm2 = 0.5 * excess;
  const Flattening left = flatten_best(bowl.mesh, bowl.whole, options);
  EXPECT_TRUE(left.notes.empty());
  EXPECT_GT(left.trace.back().error, whole.trace.back().error);
  EXPECT_EQ(measure_distortion(bowl.mesh, left.uv).flipped, 0u);
  options.give_up_excess_mm2 = 1.1 * excess;
  EXPECT_NEAR(flatten_best(bowl.mesh, bowl.whole, options).trace.back().error, whole.trace.back().error, 1e-4)
      << "what was left is not remembered";
}

/// A plate as a chart, and the map that leaves it where it is.
struct Plate {
  TriangleMesh mesh = test::plane(12, 8, 12, 8);
  ChartSurface chart;
  CornersOfVertices corners{mesh.triangles, mesh.positions.size()};
  std::vector<Vec2> uv;
  std::vector<std::array<Vec2, 3>> shapes;
  Plate() {
    chart.positions = mesh.positions;
    chart.triangles = mesh.triangles;
    for (const Vec3& p : mesh.positions) uv.push_back({p.x, p.y});
    for (const Triangle& t : mesh.triangles) shapes.push_back({uv[t[0]], uv[t[1]], uv[t[2]]});
  }
  Index at(double x, double y) const {
    for (Index v = 0; v < uv.size(); ++v)
      if (norm(mesh.positions[v] - Vec3{x, y, 0}) < 1e-9) return v;
    ADD_FAILURE() << "no vertex at " << x << ", " << y;
    return 0;
  }
  std::vector<Index> within(double left, double right) const {
    std::vector<Index> vertices;
    for (Index v = 0; v < uv.size(); ++v)
      if (uv[v].x > left && uv[v].x < right) vertices.push_back(v);
    return vertices;
  }
};

TEST(PlaceRigidly, ShapesThatFitComeBack) {
  Plate plate;
  const std::vector<Vec2> before = plate.uv;
  const std::vector<Index> free = plate.within(2.5, 8.5);
  for (const Index v : free) plate.uv[v] = plate.uv[v] + Vec2{0.4 * std::sin(3.0 * v), 0.3 * std::cos(5.0 * v)};
  place_rigidly(plate.chart, plate.corners, plate.shapes, free, plate.uv);
  for (std::size_t v = 0; v < before.size(); ++v) EXPECT_LT(norm(plate.uv[v] - before[v]), 1e-6) << v;
}

TEST(PlaceRigidly, ShapesThatAreTurnedTurnBack) {
  Plate plate;
  const std::vector<Vec2> before = plate.uv;
  const Vec2 by{std::cos(0.6), std::sin(0.6)};
  for (auto& shape : plate.shapes)
    for (Vec2& p : shape) p = turned(p, by);
  place_rigidly(plate.chart, plate.corners, plate.shapes, plate.within(2.5, 8.5), plate.uv);
  double most = 0;
  for (std::size_t v = 0; v < before.size(); ++v) most = std::max(most, norm(plate.uv[v] - before[v]));
  EXPECT_LT(most, 0.3);  // each turn brings them nearer
  EXPECT_GT(most, 0);
}

TEST(MendMap, TrianglesAreTurnedBack) {
  Plate plate;
  const std::vector<Vec2> before = plate.uv;
  plate.uv[plate.at(5, 4)] = {6.4, 4.3};
  plate.uv[plate.at(12, 8)] = {10.8, 6.9};  // a corner of the plate, over the diagonal
  ASSERT_TRUE(mend_map(plate.chart, plate.corners, plate.uv));
  for (const Triangle& t : plate.mesh.triangles)
    EXPECT_GT(cross(plate.uv[t[1]] - plate.uv[t[0]], plate.uv[t[2]] - plate.uv[t[0]]), 0);
  for (std::size_t v = 0; v < before.size(); ++v) EXPECT_LT(norm(plate.uv[v] - before[v]), 2) << v;
  for (Vec2& p : plate.uv) p.x = -p.x;
  EXPECT_FALSE(mend_map(plate.chart, plate.corners, plate.uv)) << "too much is wrong";
}

TEST(MendMap, ManyThatAreTurnedOverComeBack) {
  // Vertices within are moved by up to four cells: the middle of their neighbours is often no place for them.
  int mended = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    Plate plate;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-4, 4);
    for (Vec2& p : plate.uv)
      if (p.x > 0.5 && p.x < 11.5 && p.y > 0.5 && p.y < 7.5) p = p + Vec2{any(random), any(random)};
    mended += mend_map(plate.chart, plate.corners, plate.uv);
  }
  EXPECT_EQ(mended, 40);
}

TEST(MendMap, TheBorderIsDrawnApart) {
  // A plate with a slit whose sides lie on each other.
  const TriangleMesh mesh = test::plane(12, 8, 12, 8);
  std::vector<std::uint8_t> seam;
  const std::vector<double> costs(3 * mesh.triangles.size(), 0);
  const SeamMesh seams(mesh, costs);
  seam = test::border_seams(seams);
  test::draw_seam(seams, seam, {6, 0, 0}, {6, 5, 0});
  const ChartSet charts = charts_between(seams, seam);
  const TriangleMesh open = cut_open(mesh, charts);
  ASSERT_EQ(open.positions.size(), mesh.positions.size() + 5);
  ChartSurface chart;
  chart.positions = open.positions;
  chart.triangles = open.triangles;
  std::vector<Vec2> uv;
  for (const Vec3& p : open.positions) uv.push_back({p.x, p.y});
  ASSERT_TRUE(mend_map(chart, CornersOfVertices(open.triangles, uv.size()), uv));
  std::set<Index> moved;
  for (Index v = 0; v < uv.size(); ++v)
    if (norm(uv[v] - Vec2{open.positions[v].x, open.positions[v].y}) > 0) moved.insert(v);
  for (const Index v : moved) EXPECT_LE(std::abs(open.positions[v].x - 6), 1) << "away from the slit nothing moves";
  EXPECT_GE(moved.size(), 10u);
}

/// A plate of 24 x 16 cells with a slit along x = 12 up to y = 10 whose sides, and what lies behind them,
/// have moved over each other by up to 2.8 cells but for its tip and its mouth.
struct Pocket {
  TriangleMesh open;
  ChartSurface chart;
  std::vector<Vec2> uv;

  Pocket() {
    const TriangleMesh mesh = test::plane(24, 16, 24, 16);
    const std::vector<double> costs(3 * mesh.triangles.size(), 0);
    const SeamMesh seams(mesh, costs);
    std::vector<std::uint8_t> seam = test::border_seams(seams);
    test::draw_seam(seams, seam, {12, 0, 0}, {12, 10, 0});
    open = cut_open(mesh, charts_between(seams, seam));
    chart.positions = open.positions;
    chart.triangles = open.triangles;
    std::vector<double> side(open.positions.size(), 0);
    for (const Triangle& t : open.triangles)
      for (const Index v : t)
        for (const Index w : t) side[v] += open.positions[w].x - 12;
    for (Index v = 0; v < side.size(); ++v) {
      const Vec3 p = open.positions[v];
      const double over = p.y > 9.5 ? 0 : p.y < 2.5 ? -0.1 : 1.4;
      const double along = over * std::exp(-std::abs(p.x - 12) / 5);
      uv.push_back({p.x + (side[v] > 0 ? -along : along), p.y});
    }
  }
};

TEST(MendMap, SidesOfASlitThatHaveChangedPlacesAreDrawnBack) {
  Pocket pocket;
  const std::vector<Vec2> before = pocket.uv;
  std::vector<BorderEdge> border;
  for (const auto& [from, to] : border_of(pocket.open.triangles, pocket.uv.size()))
    border.push_back({from, to, pocket.uv[from], pocket.uv[to]});
  ASSERT_FALSE(border_proves_injective(border));
  ASSERT_TRUE(mend_map(pocket.chart, CornersOfVertices(pocket.open.triangles, pocket.uv.size()), pocket.uv));
  for (BorderEdge& edge : border) edge.a = pocket.uv[edge.from], edge.b = pocket.uv[edge.to];
  EXPECT_TRUE(border_proves_injective(border));
  for (const auto& [a, b, c] : pocket.open.triangles)
    EXPECT_GT(cross(pocket.uv[b] - pocket.uv[a], pocket.uv[c] - pocket.uv[a]), 0);
  for (Index v = 0; v < pocket.uv.size(); ++v) {
    if (std::abs(pocket.open.positions[v].x - 12) > 6) {
      EXPECT_EQ(norm(pocket.uv[v] - before[v]), 0) << "away from the slit";
    }
  }
}

TEST(NearbyMap, ARoughStartIsSmoothedBeforeNewtonsMethod) {
  // Triangles of next to no area in the map that is nearby: Newton's method alone takes 20 steps.
  const TriangleMesh mesh = test::hemisphere_mesh(20, 48, 100);
  const ChartSet charts = test::one_chart(mesh);
  const Adjacency across = connect_triangles(mesh);
  std::vector<Index> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), Index{0});
  ChartSurface chart = ChartCutter(mesh, across, charts).cut(0, all);
  const Flattening flat = flatten_best(mesh, charts, exact());
  std::mt19937 random(3);
  std::uniform_int_distribution<std::size_t> any(0, mesh.triangles.size() - 1);
  std::vector<Vec2> uv(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) uv[mesh.triangles[t][k]] = flat.uv.values[flat.uv.indices[t][k]];
  std::vector<char> moved(uv.size(), 0);
  for (int i = 0; i < 60; ++i) {
    const Triangle& t = mesh.triangles[any(random)];
    if (std::any_of(t.begin(), t.end(), [&](Index v) { return moved[v] != 0; })) continue;
    moved[t[0]] = moved[t[1]] = moved[t[2]] = 1;
    uv[t[0]] = 1e-3 * uv[t[0]] + 0.4995 * (uv[t[1]] + uv[t[2]]);
  }
  for (const Triangle& t : mesh.triangles) chart.nearby.push_back({uv[t[0]], uv[t[1]], uv[t[2]]});
  MultilevelOptions options;
  options.tolerance = 1e-4;
  const std::optional<MultilevelMap> map = map_nearby(chart, options);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->stop, StopReason::converged);
  EXPECT_LE(map->trace.size(), 4u);
  EXPECT_NEAR(map->trace.back().error, flat.trace.back().error, 1e-3);
}

TEST(SheetOverlap, EdgesThatMeetAreThoseOfAllPairs) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(0, 1);
  for (int run = 0; run < 20; ++run) {
    std::vector<BorderEdge> border;
    for (Index i = 0; i < 40; ++i) {
      const Vec2 a{any(random), 3 * any(random)};
      border.push_back({2 * i, 2 * i + 1, a, a + Vec2{0.1 * any(random), 0.1 * any(random)}});
    }
    std::vector<std::array<Index, 2>> expected;
    for (Index i = 0; i < border.size(); ++i)
      for (Index j = i + 1; j < border.size(); ++j)
        if (edges_conflict(border[i], border[j], 1e-13)) expected.push_back({i, j});
    EXPECT_EQ(expected, edges_that_meet(border)) << run;
  }
}

}  // namespace
}  // namespace papilla
