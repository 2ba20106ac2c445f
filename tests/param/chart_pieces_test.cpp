// SPDX-License-Identifier: MIT
// Triangles linked over edges and charts cut out of meshes, against counting all edges and joining all corners.
#include "chart_pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "papilla/core/union_find.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla::param_detail {
namespace {

/// Halfedges by the vertices that they run from and to.
std::map<std::pair<Index, Index>, std::vector<Index>> halfedges(const TriangleMesh& mesh) {
  std::map<std::pair<Index, Index>, std::vector<Index>> result;
  for (Index h = 0; h < 3 * mesh.triangles.size(); ++h)
    result[{mesh.triangles[h / 3][h % 3], mesh.triangles[h / 3][(h % 3 + 1) % 3]}].push_back(h);
  return result;
}

Adjacency counted(const TriangleMesh& mesh) {
  Adjacency across(3 * mesh.triangles.size(), k_no_triangle);
  const auto edges = halfedges(mesh);
  for (const auto& [ends, forward] : edges) {
    const auto backward = edges.find({ends.second, ends.first});
    if (ends.first == ends.second || forward.size() != 1 || backward == edges.end() || backward->second.size() != 1)
      continue;
    const Index other = backward->second.front() / 3;
    if (other != forward.front() / 3) across[forward.front()] = other;
  }
  return across;
}

/// Triangles of random vertices: edges of none, one, two and more triangles, both ways, and corners that repeat.
TriangleMesh random_triangles(Index vertices, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  TriangleMesh mesh;
  mesh.positions.resize(vertices);
  for (std::size_t t = 0; t < count; ++t)
    mesh.triangles.push_back({Index(random() % vertices), Index(random() % vertices), Index(random() % vertices)});
  return mesh;
}

/// Triangles around two vertices that have an edge in common, in random order.
TriangleMesh two_hubs(Index around, unsigned seed) {
  TriangleMesh mesh;
  mesh.positions.resize(2 + around);
  for (Index i = 0; i + 1 < around; ++i) mesh.triangles.push_back({i % 2, 2 + i, 3 + i});
  mesh.triangles.push_back({0, 1, 2});
  mesh.triangles.push_back({1, 0, 1 + around});
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(seed));
  return mesh;
}

TEST(Adjacency, LinksWhatExactlyTwoTrianglesHave) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const Index vertices : {4u, 12u, 40u, 200u}) {
      const TriangleMesh mesh = random_triangles(vertices, 150, seed);
      EXPECT_EQ(connect_triangles(mesh), counted(mesh)) << vertices << " vertices, seed " << seed;
    }
    const TriangleMesh hubs = two_hubs(300, seed);
    const Adjacency across = connect_triangles(hubs);
    EXPECT_EQ(across, counted(hubs));
    EXPECT_GT(std::count_if(across.begin(), across.end(), [](Index t) { return t != k_no_triangle; }), 2);
  }
}

TEST(Adjacency, LinksAcrossThePartsThatThreadsWorkOn) {
  const TriangleMesh mesh = test::spherical_cap(2, 0.9, 90, 130);
  ASSERT_GT(mesh.positions.size(), 8192u);
  EXPECT_EQ(connect_triangles(mesh), counted(mesh));
}

TEST(ChartCutter, CornersOfOneFanAreOneVertex) {
  const TriangleMesh mesh = test::spherical_cap(2, 1.9, 12, 17);
  const Adjacency across = connect_triangles(mesh);
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    ChartSet charts;
    charts.count = 3;  // of triangles here and there: charts that touch themselves at vertices
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      charts.of_triangle.push_back(random() % 8 < 6 ? 0 : 1 + random() % 2);
    const TrianglesOfCharts members = sort_by_chart(charts.of_triangle, charts.count);
    const ChartCutter cutter(mesh, across, charts);
    for (std::uint32_t c = 0; c < charts.count; ++c) {
      const auto own = members.of(c);
      const ChartSurface surface = cutter.cut(c, own);
      // All corners of all triangles that meet over an edge within the chart.
      UnionFind fans(3 * own.size());
      const auto vertex = [&](Index corner) { return mesh.triangles[own[corner / 3]][corner % 3]; };
      for (Index h = 0; h < 3 * own.size(); ++h) {
        const Index other = surface.across[h / 3][h % 3];
        const Index whole = across[3 * own[h / 3] + h % 3];
        EXPECT_EQ(other != k_no_triangle, whole != k_no_triangle && charts.of_triangle[whole] == c);
        if (other == k_no_triangle) continue;
        EXPECT_EQ(own[other], whole);
        for (Index g = 3 * other; g < 3 * other + 3; ++g)
          if (vertex(g) == vertex(h) || vertex(g) == vertex(next(h)))
            fans.unite(vertex(g) == vertex(h) ? h : next(h), g);
      }
      Index count = 0;
      const std::vector<Index> expected = fans.labels(count);
      ASSERT_EQ(surface.positions.size(), count);
      for (Index corner = 0; corner < expected.size(); ++corner) {
        EXPECT_EQ(surface.triangles[corner / 3][corner % 3], expected[corner]);
        const Vec3 p = surface.positions[expected[corner]], q = mesh.positions[vertex(corner)];
        EXPECT_TRUE(p.x == q.x && p.y == q.y && p.z == q.z);
      }
    }
  }
}

}  // namespace
}  // namespace papilla::param_detail
