// SPDX-License-Identifier: MIT
#include "papilla/meshing/segmentation.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "meshing/shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/chart_cuts.hpp"
#include "papilla/meshing/chart_topology.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/submesh.hpp"

namespace papilla {
namespace {

using namespace test;

/// Independent of the library's: cuts a chart out corner by corner and counts V - E + F, border loops and pieces with
/// maps. Corners of a vertex are one where two triangles of the chart share an edge there that they run
/// opposite ways and that is not cut.
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
  std::set<std::pair<Index, Index>> cut;
  for (const Index h : charts.cuts)
    cut.insert(std::minmax(mesh.triangles[h / 3][h % 3], mesh.triangles[h / 3][(h % 3 + 1) % 3]));
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
    const auto start = [&](std::size_t i) {
      return mesh.triangles[static_cast<std::size_t>(uses[i].first)][static_cast<std::size_t>(uses[i].second)];
    };
    if (uses.size() == 2 && start(0) != start(1) && !cut.contains(edge)) {
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

TriangleMesh scaled(TriangleMesh mesh, Vec3 by) {
  for (Vec3& p : mesh.positions) p = {by.x * p.x, by.y * p.y, by.z * p.z};
  return mesh;
}

TriangleMesh helical_ramp(int n, int across) {
  TriangleMesh mesh = grid(n, across);
  for (Vec3& p : mesh.positions) {
    const double angle = 5 * 3.14159265358979 * p.x / n, r = 1 + p.y / across;
    p = {r * std::cos(angle), -r * std::sin(angle), -0.4 * angle};
  }
  return mesh;
}

/// Lengths of the seams, added up from the triangles alone.
double plain_seam_length(const TriangleMesh& mesh, const ChartSet& charts) {
  std::map<std::pair<Index, Index>, std::vector<std::uint32_t>> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      sides[std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])].push_back(charts.of_triangle[t]);
  std::set<std::pair<Index, Index>> seams;
  for (const auto& [edge, numbers] : sides)
    if (numbers.size() == 2 && numbers[0] != numbers[1]) seams.insert(edge);
  for (const Index h : charts.cuts)
    seams.insert(std::minmax(mesh.triangles[h / 3][h % 3], mesh.triangles[h / 3][(h % 3 + 1) % 3]));
  double length = 0;
  for (const auto& [a, b] : seams) length += norm(mesh.positions[b] - mesh.positions[a]);
  return length;
}

SegmentationOptions without_unfolding() {
  SegmentationOptions options;
  options.unfold = false;
  return options;
}

TEST(Segmentation, CubeUnfoldsIntoOneNet) {
  for (const int n : {1, 4, 9}) {
    const SegmentationResult result = segment_charts(cube(n));
    EXPECT_EQ(result.charts.count, 1u);
    EXPECT_EQ(result.unfolded, 5u);
    EXPECT_NEAR(result.charts.seam_length_mm, 7, 1e-9);  // every net of a cube cuts seven edges
    expect_disks(cube(n), result);
  }
}

TEST(Segmentation, CubeHasItsSixSidesAndTwelveEdgesWithoutUnfolding) {
  for (const int n : {1, 4, 9}) {
    const SegmentationResult result = segment_charts(cube(n), without_unfolding());
    EXPECT_EQ(result.charts.count, 6u);
    EXPECT_NEAR(result.charts.seam_length_mm, 12, 1e-9);
    EXPECT_TRUE(result.charts.cuts.empty());
    expect_disks(cube(n), result);
  }
}

TEST(Segmentation, GrainGoesOnOverFeatureEdgesInItsDirectionOnly) {
  // Upright on the four walls: the walls join to a ring of four with one cut; up is no direction on top and bottom,
  // where grain runs along y here, so that they join the walls y = 0 and y = 1 alone.
  SegmentationOptions options;
  options.grain = [](Vec3 n) { return std::abs(n.z) > 0.5 ? Vec3{0, n.z > 0 ? 1.0 : -1.0, 0} : Vec3{0, 0, 1}; };
  const TriangleMesh mesh = cube(3);
  const SegmentationResult result = segment_charts(mesh, options);
  expect_disks(mesh, result);
  EXPECT_EQ(result.charts.count, 1u);
  // No direction that fits over any edge: the six sides stay.
  options.grain = [](Vec3 n) { return Vec3{std::abs(n.y), std::abs(n.z), std::abs(n.x)}; };
  EXPECT_GT(segment_charts(mesh, options).charts.count, 1u);
}

TEST(Segmentation, FlatSheetIsOneChart) {
  const SegmentationResult result = segment_charts(grid(20, 10));
  EXPECT_EQ(result.charts.count, 1u);
  EXPECT_EQ(result.charts.seam_length_mm, 0);
  expect_disks(grid(20, 10), result);
}

TEST(Segmentation, CountFollowsTheShapeNotTheTessellation) {
  const auto charts_of = [](int n) { return segment_charts(sphere(n)).charts; };
  const ChartSet coarse = charts_of(12), fine = charts_of(60);
  EXPECT_LE(fine.count, coarse.count + 1);
  EXPECT_LE(coarse.count, fine.count + 1);
  EXPECT_NEAR(fine.seam_length_mm, coarse.seam_length_mm, 0.35 * coarse.seam_length_mm);
}

TEST(Segmentation, SmoothShapesAreDisks) {
  for (const TriangleMesh& mesh : {sphere(16), torus(60, 30), tube(40, 20), double_torus(), torus(12, 6)}) {
    const SegmentationResult result = segment_charts(mesh);
    expect_disks(mesh, result);
    EXPECT_LE(result.charts.count, 12u);
    EXPECT_NEAR(result.charts.seam_length_mm, plain_seam_length(mesh, result.charts), 1e-9);
    EXPECT_NEAR(seam_length(mesh, result.charts), result.charts.seam_length_mm, 1e-9);
  }
}

TEST(Segmentation, CheapSeamsCutMoreDearOnesLess) {
  const TriangleMesh mesh = sphere(20);
  double before = 1e300;
  for (const double cost : {0.003, 0.03, 0.3}) {
    SegmentationOptions options;
    options.seam_cost = cost;
    const double length = segment_charts(mesh, options).charts.seam_length_mm;
    EXPECT_LE(length, before);
    before = length;
  }
  EXPECT_GT(before, 0);  // a closed surface needs one cut at any price
}

TEST(Segmentation, TubeIsOneChartWithOneStraightCut) {
  const TriangleMesh mesh = tube(64, 8);
  const SegmentationResult result = segment_charts(mesh);
  EXPECT_EQ(result.charts.count, 1u);
  EXPECT_EQ(result.disk_cuts, 1u);
  EXPECT_EQ(result.charts.cuts.size(), 8u);
  EXPECT_NEAR(result.charts.seam_length_mm, 2, 1e-9);
  expect_disks(mesh, result);
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

TEST(Segmentation, PlateWithHolesNeedsCutsForDisksOnly) {
  for (const int holes : {1, 2, 5, 12}) {
    const TriangleMesh mesh = plate_with_holes(holes);
    const SegmentationResult disks = segment_charts(mesh);
    expect_disks(mesh, disks);
    EXPECT_EQ(disks.charts.count, 1u) << holes;
    EXPECT_NEAR(disks.charts.seam_length_mm, 2 * holes, 1e-9);  // each hole is 2 from the border or the next one
    SegmentationOptions options;
    options.disks = false;
    const SegmentationResult whole = segment_charts(mesh, options);
    EXPECT_EQ(whole.charts.count, 1u);
    EXPECT_EQ(whole.charts.seam_length_mm, 0);
    EXPECT_EQ(chart_topology(mesh, whole.charts, 0).boundary_loops, 1u + static_cast<unsigned>(holes));
  }
}

TEST(Segmentation, TubeIsOpenedEvenWhereHolesMayStay) {
  SegmentationOptions options;
  options.disks = false;
  const SegmentationResult result = segment_charts(tube(40, 8), options);
  EXPECT_EQ(result.charts.count, 1u);
  expect_disks(tube(40, 8), result);
}

TEST(Segmentation, CutsRunWhereTheyAreSeldomSeen) {
  // A tube within a box that is open at the side x > 0: the tube's cut lies on its far side.
  TriangleMesh mesh = tube(32, 4);
  const TriangleMesh walls = moved(scaled(tube(4, 1), {3, 3, 1}), {0, 0, 0});
  TriangleMesh open_box = walls;
  std::erase_if(open_box.triangles, [&](const Triangle& t) {
    return walls.positions[t[0]].x + walls.positions[t[1]].x + walls.positions[t[2]].x > 1;
  });
  mesh = joined(mesh, open_box);
  const ChartSet charts = segment_charts(mesh).charts;
  ASSERT_FALSE(charts.cuts.empty());
  for (const Index h : charts.cuts) EXPECT_LT(mesh.positions[mesh.triangles[h / 3][h % 3]].x, 0.2);
}

TEST(Segmentation, HelixThatWouldOverlapItselfIsParted) {
  const TriangleMesh mesh = helical_ramp(90, 4);  // two and a half turns in a plane
  const SegmentationResult result = segment_charts(mesh);
  expect_disks(mesh, result);
  EXPECT_GE(result.charts.count, 3u);
  EXPECT_LE(result.charts.count, 6u);
}

TEST(Segmentation, SliversAndScaleChangeNothing) {
  const TriangleMesh mesh = scaled(torus(40, 16), {1, 1, 1});
  const ChartSet charts = segment_charts(mesh).charts;
  for (const double factor : {1e-6, 1e6}) {
    const ChartSet same = segment_charts(scaled(mesh, {factor, factor, factor})).charts;
    EXPECT_EQ(same.count, charts.count);
    EXPECT_NEAR(same.seam_length_mm, factor * charts.seam_length_mm, 1e-6 * factor * charts.seam_length_mm);
  }
  const TriangleMesh needles = scaled(grid(4, 4000), {1, 1e-7, 1});  // aspect 1e7
  EXPECT_EQ(segment_charts(needles).charts.count, 1u);
}

TEST(Segmentation, LoneTrianglesJoinTheirNeighbours) {
  TriangleMesh mesh = grid(6, 6);
  mesh.positions[mesh.triangles[30][1]].z = 2;  // six steep triangles in a flat sheet
  const SegmentationResult result = segment_charts(mesh);
  for (const ChartTopology& chart : chart_topologies(mesh, result.charts)) EXPECT_GT(chart.triangles, 1u);
  expect_disks(mesh, result);
}

TEST(Segmentation, SameForAnyNumberOfThreads) {
  const TriangleMesh mesh = joined(terrain(30, 2, 4), double_torus());
  const ChartSet many = segment_charts(mesh).charts;
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const ChartSet single = segment_charts(mesh).charts;
  EXPECT_EQ(single.of_triangle, many.of_triangle);
  EXPECT_EQ(single.cuts, many.cuts);
}

TEST(CutOpen, OpensCutsAndKeepsEverythingElse) {
  TriangleMesh mesh = tube(16, 5);
  set_uv_to_xy(mesh);
  const ChartSet charts = segment_charts(mesh).charts;
  const TriangleMesh open = cut_open(mesh, charts);
  EXPECT_EQ(open.positions.size(), mesh.positions.size() + 6);  // five edges, open at both ends
  EXPECT_TRUE(uv_is_xy(open, 0));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(open.corner(t, k), mesh.corner(t, k));
  EXPECT_TRUE(chart_topology(open, {charts.of_triangle, 1, 0}, 0).is_disk());
  EXPECT_FALSE(chart_topology(mesh, {charts.of_triangle, 1, 0}, 0).is_disk());
  ChartSet bad = charts;
  bad.cuts = {999999};
  EXPECT_THROW(cut_open(mesh, bad), InvalidInput);
  EXPECT_EQ(cut_open(grid(2, 2), {std::vector<std::uint32_t>(8, 0), 1, 0}).positions.size(), 9u);
}

TEST(CutOpen, KeepsCutsThatLieWithinACharts) {
  const TriangleMesh mesh = tube(16, 4);
  const ChartSet charts = segment_charts(mesh).charts;
  ChartSet halves = charts;
  halves.count = 2;  // below and above the middle
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    halves.of_triangle[t] = mesh.corner(t, 0).z + mesh.corner(t, 1).z + mesh.corner(t, 2).z > 3 ? 1 : 0;
  const CutOpener opener(mesh);
  opener.keep_cuts(charts.cuts, halves);
  EXPECT_EQ(halves.cuts, charts.cuts);
  EXPECT_NEAR(halves.seam_length_mm, plain_seam_length(mesh, halves), 1e-12);
  ChartSet sides = charts;
  sides.count = 2;  // parted along the cut, among others
  const Index h = charts.cuts.front();
  sides.of_triangle[h / 3] = 1;
  opener.keep_cuts(charts.cuts, sides);
  EXPECT_EQ(sides.cuts.size(), charts.cuts.size() - 1);
}

TEST(CutOpen, WhereThreeTrianglesMeetTwoOfOneChartAreNeighbours) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 2, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const CutOpener opener(mesh);
  ChartSet two{{0, 0, 1}, 2, 0, {}};
  opener.keep_cuts(std::array<Index, 1>{0}, two);
  EXPECT_EQ(two.cuts, std::vector<Index>{0});
  const TriangleMesh open = opener.open(two);
  EXPECT_EQ(open.positions.size(), 7u);
  EXPECT_EQ(open.triangles[0], mesh.triangles[0]);
  EXPECT_EQ(open.triangles[1], (Triangle{5, 6, 3}));
  EXPECT_EQ(open.triangles[2], mesh.triangles[2]);
  ChartSet one{{0, 0, 0}, 1, 0, {}};
  opener.keep_cuts(std::array<Index, 1>{0}, one);
  EXPECT_TRUE(one.cuts.empty());
  one.cuts = {0};
  EXPECT_THROW(opener.open(one), InvalidInput);
  EXPECT_THROW(opener.seam_length(one), InvalidInput);
  EXPECT_THROW(opener.keep_cuts(std::array<Index, 1>{9}, one), InvalidInput);
}

TEST(CutOpen, OneOpenerServesAllChartsOfAMesh) {
  const TriangleMesh mesh = tube(16, 4);
  const CutOpener opener(mesh);
  const auto from = [&](Index h) { return mesh.triangles[h / 3][h % 3]; };
  const auto to = [&](Index h) { return mesh.triangles[h / 3][(h % 3 + 1) % 3]; };
  std::map<std::pair<Index, Index>, int> triangles_at;
  for (Index h = 0; h < 3 * mesh.triangles.size(); ++h) ++triangles_at[std::minmax(from(h), to(h))];
  std::set<Index> on_border;
  for (const auto& [edge, count] : triangles_at)
    if (count == 1) on_border.insert({edge.first, edge.second});
  ChartSet charts{std::vector<std::uint32_t>(mesh.triangles.size(), 0), 1, 0, {}};
  std::size_t grown = 0;
  for (Index h = 0; h < 3 * mesh.triangles.size(); ++h) {
    charts.cuts = {h};
    if (triangles_at[std::minmax(from(h), to(h))] == 1) {
      EXPECT_THROW(opener.open(charts), InvalidInput);
      continue;
    }
    // One edge parts the triangles around its ends where these lie on the border.
    const std::size_t ends = on_border.count(from(h)) + on_border.count(to(h));
    EXPECT_EQ(opener.open(charts).positions.size(), mesh.positions.size() + ends);
    EXPECT_NEAR(opener.seam_length(charts), plain_seam_length(mesh, charts), 1e-12);
    grown += ends;
  }
  EXPECT_GT(grown, 0u);
}

TEST(ChartCuts, OpenAndHalveChartsOfAnyOrigin) {
  for (const TriangleMesh& mesh : {sphere(6), torus(24, 12), double_torus(), tube(20, 5), plate_with_holes(3)}) {
    const ChartSet one{std::vector<std::uint32_t>(mesh.triangles.size(), 0), 1, 0};
    SegmentationResult result;
    result.charts = open_charts(mesh, one);
    expect_disks(mesh, result);
    EXPECT_EQ(result.charts.count, 1u);
    result.charts = ChartHalver(mesh).halve(result.charts, std::vector<std::uint32_t>{0});
    expect_disks(mesh, result);
    EXPECT_EQ(result.charts.count, 2u);
  }
  const TriangleMesh sheet = grid(12, 4);
  const ChartSet halves =
      ChartHalver(sheet).halve({std::vector<std::uint32_t>(96, 0), 1, 0}, std::vector<std::uint32_t>{0});
  EXPECT_NEAR(halves.seam_length_mm, 4, 1e-9);  // straight across
  EXPECT_THROW(ChartHalver(sheet).halve(halves, std::vector<std::uint32_t>{2}), InvalidInput);
}

/// A fin on the first edge of a triangle: three triangles meet there, so that none has a neighbour across it.
TriangleMesh with_fin(TriangleMesh mesh, std::size_t triangle) {
  const Index a = mesh.triangles[triangle][0], b = mesh.triangles[triangle][1];
  mesh.triangles.push_back({a, b, static_cast<Index>(mesh.positions.size())});
  mesh.positions.push_back(1.4 * mesh.positions[a]);
  return mesh;
}

TEST(ChartCuts, TwoBordersBetweenTheSameVerticesAreASlit) {
  for (const TriangleMesh& whole : {sphere(6), torus(24, 12), torus(9, 14), double_torus()})
    for (const std::size_t at : {std::size_t{0}, whole.triangles.size() / 3, whole.triangles.size() - 1}) {
      const TriangleMesh mesh = with_fin(whole, at);
      ChartSet charts{std::vector<std::uint32_t>(mesh.triangles.size(), 0), 2, 0};
      charts.of_triangle.back() = 1;
      SegmentationResult result;
      result.charts = open_charts(mesh, charts);
      EXPECT_EQ(result.charts.count, 2u);
      expect_disks(mesh, result);
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
  EXPECT_GT(segment_charts(mesh, options).absorbed, 0u);
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
  options = {};
  options.union_trials = -1;
  EXPECT_THROW(segment_charts(cube(), options), InvalidInput);
}

TEST(Segmentation, FewerTrialsJoinFewerCharts) {
  const TriangleMesh mesh = terrain(40, 3, 5);
  SegmentationOptions options;
  const std::uint32_t usual = segment_charts(mesh, options).charts.count;
  options.union_trials = 0;
  const SegmentationResult none = segment_charts(mesh, options);
  EXPECT_GT(none.charts.count, usual);
  expect_disks(mesh, none);
}

TEST(Segmentation, ProgressGoesOnWithinOnePatch) {
  std::vector<double> told;
  SegmentationOptions options;
  options.progress = [&](const Progress& done) { return told.push_back(done.fraction), true; };
  segment_charts(terrain(40, 3, 5), options);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1);
  for (const double begin : {0.3, 0.7})
    EXPECT_GE(std::count_if(told.begin(), told.end(), [&](double f) { return f > begin && f < begin + 0.2; }), 2)
        << "after " << begin;
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
