// SPDX-License-Identifier: MIT
#include "map_level.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "map_descent.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// A curved sheet of four chunks of vertices, with cells of about 7 mm.
TriangleMesh sheet() { return test::dashboard_mesh(200, 80); }

/// Its shadow on the ground, every vertex shifted by up to 1 mm: what relaxing smooths at once.
std::vector<Vec2> rough_shadow(const TriangleMesh& mesh) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-1, 1);
  std::vector<Vec2> uv;
  for (const Vec3& p : mesh.positions) uv.push_back({p.x + shift(random), p.y + shift(random)});
  return uv;
}

MapLevel level_of(const TriangleMesh& mesh) {
  ChartSurface chart;
  chart.positions = mesh.positions;
  chart.triangles = mesh.triangles;
  return whole_level(chart, rough_shadow(mesh));
}

/// The same mesh with its vertices in another order: most have a neighbour in a later chunk.
TriangleMesh shuffled(const TriangleMesh& mesh) {
  std::vector<Index> number(mesh.positions.size());
  std::iota(number.begin(), number.end(), Index{0});
  std::shuffle(number.begin(), number.end(), std::mt19937(7));
  TriangleMesh result = mesh;
  for (Index v = 0; v < number.size(); ++v) result.positions[number[v]] = mesh.positions[v];
  for (Triangle& t : result.triangles)
    for (Index& v : t) v = number[v];
  return result;
}

double energy_of(const MapLevel& level) {
  const SymmetricDirichlet energy(level.rest);
  return total_energy({level.triangles, &energy, nullptr}, level.uv);
}

bool is_valid(const MapLevel& level) {
  return std::ranges::all_of(level.triangles, [&](const Triangle& t) {
    return cross(level.uv[t[1]] - level.uv[t[0]], level.uv[t[2]] - level.uv[t[0]]) > 0;
  });
}

TEST(Relax, ChunksSideBySideGiveTheSameBytesForAnyNumberOfThreads) {
  for (const TriangleMesh& mesh : {sheet(), shuffled(sheet())}) {
    const MapLevel start = level_of(mesh);
    std::vector<MapLevel> relaxed;
    for (const std::size_t threads : {1u, 2u, 4u}) {
      const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
      relaxed.push_back(start);
      EXPECT_EQ(relax(relaxed.back(), 6, 0, false), 6);
    }
    EXPECT_EQ(relaxed[0].uv, relaxed[1].uv);
    EXPECT_EQ(relaxed[0].uv, relaxed[2].uv);
    EXPECT_TRUE(is_valid(relaxed[0]));
    // What is above the least energy, 4 per area, shrinks: no vertex is left out.
    EXPECT_LT(energy_of(relaxed[0]) - 4 * start.area, 0.6 * (energy_of(start) - 4 * start.area));
    for (Index v = 0; v < start.uv.size(); ++v) ASSERT_NE(relaxed[0].uv[v], start.uv[v]);
  }
}

TEST(Relax, InOneChunkVerticesMoveInTheirOrder) {
  const TriangleMesh mesh = test::dashboard_mesh(40, 20);
  MapLevel level = level_of(mesh), guarded = level;
  relax(level, 3, 0, false);
  relax(guarded, 3, 0, true);  // its border is far from itself
  EXPECT_EQ(level.uv, guarded.uv);
}

/// A halfedge is of the border when none runs the other way.
std::vector<BorderPair> border_by_search(const std::vector<Triangle>& triangles) {
  std::set<BorderPair> all;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) all.insert({t[k], t[(k + 1) % 3]});
  std::vector<BorderPair> border;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (!all.contains({t[(k + 1) % 3], t[k]})) border.push_back({t[k], t[(k + 1) % 3]});
  return border;
}

TEST(BorderOf, IsWhatRunsOneWayOnly) {
  TriangleMesh holed = test::dashboard_mesh(12, 7);
  std::erase_if(holed.triangles, [n = 0](const Triangle&) mutable { return n++ % 17 == 5; });
  for (const TriangleMesh& mesh : {test::dashboard_mesh(9, 4), test::needle_strip(30, 1, 10), holed, test::cube(2)}) {
    const std::vector<Triangle> triangles(mesh.triangles.begin(), mesh.triangles.end());
    EXPECT_EQ(border_of(triangles, mesh.positions.size()), border_by_search(triangles));
  }
}

TEST(CurrentLevel, SliversAreTheTrianglesThatCountAsMoreThanTheyHave) {
  TriangleMesh mesh = sheet();
  // Every eleventh triangle loses its height, along with its neighbours' shape.
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 11) {
    const auto [a, b, c] = mesh.triangles[t];
    mesh.positions[c] = 0.5 * (mesh.positions[a] + mesh.positions[b]);
  }
  const DiskHierarchy hierarchy(mesh.positions, mesh.triangles, mesh.positions.size());
  ASSERT_EQ(hierarchy.removed_count(), 0u);
  const LeastArea least{0.5, 1e-4};
  const MapLevel level = current_level(hierarchy, mesh.positions, rough_shadow(mesh), least);
  ASSERT_EQ(level.triangles.size(), mesh.triangles.size());
  const double edge = least_edge(mesh.positions, mesh.triangles);
  std::vector<Sliver> slivers;
  double area = 0;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const RestShape own = rest_shape(mesh.positions[a], mesh.positions[b], mesh.positions[c], edge);
    const RestShape counted = rest_shape(mesh.positions[a], mesh.positions[b], mesh.positions[c], edge, least);
    if (counted.area > own.area) slivers.push_back({t, own});
    area += counted.area;
  }
  ASSERT_GT(slivers.size(), mesh.triangles.size() / 20);
  ASSERT_EQ(level.slivers.size(), slivers.size());
  for (std::size_t i = 0; i < slivers.size(); ++i) {
    EXPECT_EQ(level.slivers[i].triangle, slivers[i].triangle);
    EXPECT_NEAR(level.slivers[i].shape.area, slivers[i].shape.area, 1e-12 * area);
  }
  EXPECT_NEAR(level.area, area, 1e-12 * area);
}

}  // namespace
}  // namespace papilla
