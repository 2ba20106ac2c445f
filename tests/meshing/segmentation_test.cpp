// SPDX-License-Identifier: MIT
#include "papilla/meshing/segmentation.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>

#include "meshing/shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/meshing/chart_topology.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/submesh.hpp"

namespace papilla {
namespace {

using namespace test;

/// Independent of the library's: cuts a chart out corner by corner and counts V - E + F, border loops and pieces with
/// maps. Corners of a vertex are one where triangles of the chart share an edge there.
struct Count {
  int vertices = 0, edges = 0, faces = 0, loops = 0, pieces = 0;
};

class PlainSets {
 public:
  int root(std::pair<int, int> a) {
    const int i = number(a);
    return root_of(i);
  }
  void join(std::pair<int, int> a, std::pair<int, int> b) { parent_[root_of(number(a))] = root_of(number(b)); }

 private:
  int number(std::pair<int, int> a) {
    const auto [place, is_new] = numbers_.try_emplace(a, static_cast<int>(parent_.size()));
    if (is_new) parent_[place->second] = place->second;
    return place->second;
  }
  int root_of(int i) {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }
  std::map<std::pair<int, int>, int> numbers_;
  std::map<int, int> parent_;
};

Count count_chart(const TriangleMesh& mesh, const ChartSet& charts, std::uint32_t chart) {
  std::map<std::pair<Index, Index>, std::vector<std::pair<int, int>>> sides;  // undirected edge -> (triangle, corner)
  Count count;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (charts.of_triangle[t] != chart) continue;
    ++count.faces;
    for (std::size_t k = 0; k < 3; ++k)
      sides[std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])].emplace_back(t, k);
  }
  PlainSets corners, pieces;
  std::vector<std::pair<int, int>> border;
  for (const auto& [edge, uses] : sides) {
    if (uses.size() == 2) {
      const auto [a, b] = std::pair(uses[0], uses[1]);
      corners.join({a.first, a.second}, {b.first, (b.second + 1) % 3});
      corners.join({a.first, (a.second + 1) % 3}, {b.first, b.second});
      pieces.join({a.first, 0}, {b.first, 0});
      ++count.edges;
    } else {
      count.edges += static_cast<int>(uses.size());
      border.insert(border.end(), uses.begin(), uses.end());
    }
  }
  std::set<int> vertex_roots, piece_roots, loop_roots;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (charts.of_triangle[t] == chart) {
      for (int k = 0; k < 3; ++k) vertex_roots.insert(corners.root({static_cast<int>(t), k}));
      piece_roots.insert(pieces.root({static_cast<int>(t), 0}));
    }
  PlainSets loops;
  for (const auto& [t, k] : border) loops.join({corners.root({t, k}), 0}, {corners.root({t, (k + 1) % 3}), 0});
  for (const auto& [t, k] : border) loop_roots.insert(loops.root({corners.root({t, k}), 0}));
  count.vertices = static_cast<int>(vertex_roots.size());
  count.pieces = static_cast<int>(piece_roots.size());
  count.loops = static_cast<int>(loop_roots.size());
  return count;
}

void expect_disks(const TriangleMesh& mesh, const SegmentationResult& result) {
  ASSERT_EQ(result.charts.of_triangle.size(), mesh.triangles.size());
  std::set<std::uint32_t> used(result.charts.of_triangle.begin(), result.charts.of_triangle.end());
  EXPECT_EQ(used.size(), result.charts.count);
  EXPECT_EQ(used.empty() ? 0 : *used.rbegin() + 1, result.charts.count);
  const std::vector<ChartTopology> topologies = chart_topologies(mesh, result.charts);
  for (std::uint32_t c = 0; c < result.charts.count; ++c) {
    const Count count = count_chart(mesh, result.charts, c);
    EXPECT_EQ(count.vertices - count.edges + count.faces, 1) << "chart " << c;
    EXPECT_EQ(count.loops, 1) << "chart " << c;
    EXPECT_EQ(count.pieces, 1) << "chart " << c;
    EXPECT_TRUE(topologies[c].is_disk()) << "chart " << c;
  }
}

/// The area of all triangles outside their chart's cone, as a fraction.
double outside_cone(const TriangleMesh& mesh, const ChartSet& charts, double angle_deg) {
  const auto vector = [&](std::size_t t) {
    return 0.5 * cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0));
  };
  std::vector<Vec3> axis(charts.count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    axis[charts.of_triangle[t]] = axis[charts.of_triangle[t]] + vector(t);
  double outside = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (dot(normalized(axis[charts.of_triangle[t]]), normalized(vector(t))) <
        std::cos(angle_deg * k_radians_per_degree))
      outside += norm(vector(t));
  return outside / area(mesh);
}

TEST(Segmentation, CubeHasItsSixSidesAndTwelveEdges) {
  for (const int n : {1, 4, 9}) {
    const SegmentationResult result = segment_charts(cube(n));
    EXPECT_EQ(result.charts.count, 6u);
    EXPECT_NEAR(result.charts.seam_length_mm, 12, 1e-9);
    expect_disks(cube(n), result);
  }
}

TEST(Segmentation, FlatSheetIsOneChart) {
  const SegmentationResult result = segment_charts(grid(20, 10));
  EXPECT_EQ(result.charts.count, 1u);
  EXPECT_EQ(result.charts.seam_length_mm, 0);
  expect_disks(grid(20, 10), result);
}

TEST(Segmentation, CountFollowsTheShapeNotTheTessellation) {
  const auto charts_of = [](int n) { return segment_charts(sphere(n)).charts.count; };
  EXPECT_GE(charts_of(10), 4u);
  EXPECT_LE(charts_of(10), 12u);
  EXPECT_LE(charts_of(80), 12u);
}

TEST(Segmentation, SmoothShapesKeepTheConeAndAreDisks) {
  const SegmentationOptions options;
  for (const TriangleMesh& mesh : {sphere(16), torus(60, 30), tube(40, 20), double_torus(), torus(12, 6)}) {
    const SegmentationResult result = segment_charts(mesh);
    expect_disks(mesh, result);
    EXPECT_LE(outside_cone(mesh, result.charts, options.max_normal_deviation_deg + 1),
              2 * options.outlier_area_fraction);
  }
}

TEST(Segmentation, WideConeLeavesTheCuttingToTopology) {
  SegmentationOptions options;
  options.feature_angle_deg = 180;
  options.max_normal_deviation_deg = 180;
  for (const TriangleMesh& mesh : {sphere(8), torus(30, 12), tube(20, 8), double_torus(), cube(2)}) {
    const SegmentationResult result = segment_charts(mesh, options);
    expect_disks(mesh, result);
    EXPECT_EQ(result.cone_charts, 1u);
    EXPECT_LE(result.charts.count, 12u);
  }
}

TEST(Segmentation, TubeIsCutOnceAcrossFromTheShortestPath) {
  SegmentationOptions options;
  options.max_normal_deviation_deg = 180;
  const TriangleMesh mesh = tube(64, 8);
  const SegmentationResult result = segment_charts(mesh, options);
  EXPECT_EQ(result.charts.count, 2u);
  EXPECT_EQ(result.disk_cuts, 1u);
  EXPECT_NEAR(result.charts.seam_length_mm, 4, 0.5);  // two cuts of length 2
}

TriangleMesh plate_with_holes(int holes) {
  TriangleMesh mesh = grid(4 * holes + 2, 6);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    Vec3 c{};
    for (const Index v : t) c = c + (1.0 / 3) * mesh.positions[v];
    const double x = std::fmod(c.x, 4);
    return x > 2 && c.x < 4 * holes && c.y > 2 && c.y < 4;
  });
  return mesh;
}

TEST(Segmentation, PlateWithHolesInARowFallsIntoFewDisks) {
  for (const int holes : {1, 2, 5, 12}) {
    const TriangleMesh mesh = plate_with_holes(holes);
    const SegmentationResult result = segment_charts(mesh);
    expect_disks(mesh, result);
    EXPECT_EQ(result.feature_patches, 1u);
    EXPECT_LE(result.charts.count, 4u) << holes;
  }
}

TEST(Segmentation, RandomTerrainsAndRepairedSoups) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const TriangleMesh rough = terrain(30, 2, seed);
    expect_disks(rough, segment_charts(rough));
    const TriangleMesh soup = repair(lattice_soup(120, seed)).mesh;
    expect_disks(soup, segment_charts(soup));
  }
  const TriangleMesh strip = repair(moebius(30)).mesh;
  expect_disks(strip, segment_charts(strip));
}

TEST(Segmentation, UnrepairedMeshesStillPartitionIntoDisks) {
  for (const TriangleMesh& mesh : {moebius(30), voxels({{0, 0, 0}, {1, 1, 0}, {1, 1, 1}}), soup_of(cube(2))})
    expect_disks(mesh, segment_charts(mesh));
}

TEST(Segmentation, NoiseDoesNotShatter) {
  const TriangleMesh mesh = terrain(60, 0.2, 11);
  const SegmentationResult result = segment_charts(mesh);
  EXPECT_LE(result.charts.count, 3u);
}

TEST(Segmentation, SpecksBoundTheCountOnTheRoughestSurface) {
  const TriangleMesh mesh = terrain(40, 3, 5);  // most edges are bent by more than the feature angle
  SegmentationOptions options;
  options.speck_area_fraction = 0;
  EXPECT_GT(segment_charts(mesh, options).charts.count, 300u);
  options.speck_area_fraction = 0.01;
  const SegmentationResult result = segment_charts(mesh, options);
  EXPECT_LE(result.charts.count, 120u);
  expect_disks(mesh, result);
}

TEST(Segmentation, EmptyMeshAndBadOptions) {
  EXPECT_EQ(segment_charts({}).charts.count, 0u);
  SegmentationOptions options;
  options.feature_angle_deg = 0;
  EXPECT_THROW(segment_charts(cube(), options), InvalidInput);
}

TEST(ChartTopology, KnownShapes) {
  const auto topology = [](const TriangleMesh& mesh) {
    return chart_topology(mesh, {std::vector<std::uint32_t>(mesh.triangles.size(), 0), 1, 0}, 0);
  };
  EXPECT_EQ(topology(sphere(4)).euler, 2);
  EXPECT_TRUE(topology(sphere(4)).closed());
  EXPECT_EQ(topology(torus(12, 8)).genus(), 1);
  EXPECT_EQ(topology(double_torus()).genus(), 2);
  EXPECT_EQ(topology(tube(9, 3)).boundary_loops, 2u);
  EXPECT_TRUE(topology(grid(3, 3)).is_disk());
  EXPECT_EQ(topology(joined(grid(3, 3), moved(grid(2, 2), {9, 9, 9}))).components, 2u);
  EXPECT_THROW(chart_topology(cube(), {std::vector<std::uint32_t>(12, 0), 1, 0}, 1), InvalidInput);
  EXPECT_THROW(chart_topologies(cube(), {std::vector<std::uint32_t>(11, 0), 1, 0}), InvalidInput);
}

TEST(Submesh, MapsBackAndPartsTouchingPoints) {
  const TriangleMesh mesh = grid(2, 2);
  // Two quadrangles that touch in the middle vertex only.
  const std::vector<Index> corner_quads = {0, 1, 6, 7};
  const Submesh piece = extract(mesh, corner_quads);
  EXPECT_EQ(piece.triangles.size(), 4u);
  EXPECT_EQ(piece.positions.size(), 8u);
  EXPECT_EQ(piece.triangle_of, corner_quads);
  for (std::size_t t = 0; t < 4; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index local = piece.triangles[t][k];
      EXPECT_EQ(piece.vertex_of[local], mesh.triangles[corner_quads[t]][k]);
      EXPECT_EQ(piece.positions[local], mesh.positions[piece.vertex_of[local]]);
    }
  EXPECT_THROW(extract(mesh, std::vector<Index>{99}), InvalidInput);
}

}  // namespace
}  // namespace papilla
