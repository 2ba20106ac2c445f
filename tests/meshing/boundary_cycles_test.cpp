// SPDX-License-Identifier: MIT
#include "papilla/meshing/boundary_cycles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meshing/shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/statistics.hpp"

namespace papilla {
namespace {

using namespace test;

/// Rectangular pages of 2 x n triangles that share one spine; every second page runs the other way.
TriangleMesh book(int pages, int n) {
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i) mesh.positions.push_back({0, 0, static_cast<double>(i)});
  for (int p = 0; p < pages; ++p) {
    const double angle = 2 * std::numbers::pi * p / pages;
    const auto first = static_cast<Index>(mesh.positions.size());
    for (int i = 0; i <= n; ++i)
      mesh.positions.push_back({n * std::cos(angle), n * std::sin(angle), static_cast<double>(i)});
    for (Index i = 0; i < static_cast<Index>(n); ++i) {
      const Index a = i, b = i + 1, c = first + i, d = first + i + 1;
      const bool turned = p % 2 == 1;
      mesh.triangles.push_back(turned ? Triangle{a, b, c} : Triangle{a, c, b});
      mesh.triangles.push_back(turned ? Triangle{c, b, d} : Triangle{c, d, b});
    }
  }
  return mesh;
}

TEST(BoundaryCycles, AreTheLoopsOfManifoldMeshes) {
  EXPECT_EQ(boundary_cycles({}), 0u);
  EXPECT_EQ(boundary_cycles(double_torus()), 0u);
  EXPECT_EQ(boundary_cycles(grid(4, 3)), 1u);
  EXPECT_EQ(boundary_cycles(tube(9, 2)), 2u);
  EXPECT_EQ(boundary_cycles(moebius(12)), 1u);
  EXPECT_EQ(boundary_cycles(joined(grid(2, 2), moved(tube(5, 1), {9, 0, 0}))), 3u);
}

TEST(BoundaryCycles, CountEdgesOfAnOddNumberOfSheets) {
  EXPECT_EQ(boundary_cycles(book(2, 3)), 1u);
  EXPECT_EQ(boundary_cycles(book(3, 3)), 3u);  // three arcs and the spine from end to end: 4 - 2 + 1
  EXPECT_EQ(boundary_cycles(book(4, 3)), 3u);
  EXPECT_EQ(boundary_cycles(book(5, 3)), 5u);  // five arcs and the spine
}

TEST(BoundaryCycles, CountLoopsThatTouchOneByOne) {
  TriangleMesh bow;
  bow.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  bow.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(boundary_cycles(bow), 2u);
  EXPECT_EQ(mesh_statistics(bow).boundary_loops, 1u);  // connected through a vertex
}

TEST(BoundaryCycles, NeverRiseWhenSheetsArePartedInRepair) {
  for (int pages = 2; pages <= 7; ++pages) {
    const TriangleMesh mesh = book(pages, 3);
    const RepairResult result = repair(mesh);
    EXPECT_EQ(mesh_statistics(result.mesh).nonmanifold_edges, 0u);
    EXPECT_EQ(boundary_cycles(result.mesh), static_cast<std::size_t>((pages + 1) / 2)) << pages;
    EXPECT_LE(boundary_cycles(result.mesh), boundary_cycles(mesh)) << pages;
  }
}

TEST(BoundaryCycles, RefuseIndicesOutOfRange) {
  TriangleMesh mesh = grid(1, 1);
  mesh.triangles.front()[1] = 99;
  EXPECT_THROW(boundary_cycles(mesh), InvalidInput);
}

}  // namespace
}  // namespace papilla
