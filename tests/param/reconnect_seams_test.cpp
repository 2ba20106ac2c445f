// SPDX-License-Identifier: MIT
#include "reconnect_seams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <vector>

#include "cheapest_ways.hpp"
#include "drawn_seams.hpp"
#include "move_tips.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// A flat sheet of 12 x 7 cells, 1 wide and 0.7 high. Its maps are the sheet itself; what they are good for is said by
/// each test, so that the shortest seams are known.
class Sheet : public testing::Test {
 protected:
  static constexpr int k_columns = 12, k_rows = 7;
  static constexpr double k_high = 0.7;

  Sheet() : mesh_(test::plane(k_columns, k_rows * k_high, k_columns, k_rows)), costs_(3 * mesh_.triangles.size()) {
    const SeamMesh plain(mesh_, costs_);
    for (Index h = 0; h < costs_.size(); ++h) costs_[h] = plain.length(h);
  }

  /// A point of the grid, in cells.
  Vec3 at(double column, double row) const {
    return {mesh_.positions[0].x + column, mesh_.positions[0].y + k_high * row, mesh_.positions[0].z};
  }
  bool is_at(Index v, double column, double row) const { return norm(mesh_.positions[v] - at(column, row)) < 1e-9; }

  /// Slits of a map are open, the wider the farther from their tips.
  void open_slits(const std::vector<std::uint8_t>& seam, CornerAttribute<Vec2>& uv) const {
    std::vector<int> degree(mesh_.positions.size(), 0);
    for (Index h = 0; h < seam.size(); ++h)
      if (seam[h] && seams_.opposite[h] != k_no_triangle) ++degree[seams_.from(h)];
    std::vector<Index> tips;
    for (Index v = 0; v < degree.size(); ++v)
      if (degree[v] == 1 && !seams_.on_border[v]) tips.push_back(v);
    CheapestWays ways(seams_);
    ways.search(
        tips, [&](Index h) { return seam[h] ? seams_.length(h) : 1e9; }, [](Index, double) { return true; },
        [](Index) { return false; });
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (const Index copy = uv.indices[t][k]; copy >= mesh_.positions.size())
          uv.values[copy].x =
              mesh_.positions[mesh_.triangles[t][k]].x + 0.02 * std::min(1e3, ways.cost(mesh_.triangles[t][k]));
  }

  void cut(std::vector<std::uint8_t>& seam, Vec3 a, Vec3 b) const { test::draw_seam(seams_, seam, a, b); }
  std::vector<std::uint8_t> borders() const { return test::border_seams(seams_); }

  /// Keeps the bound where all seams hang together with the border and `missing` names no half-edge: the energy lies
  /// where these are.
  SeamState map(const std::vector<std::uint8_t>& seam,
                const std::function<std::vector<Index>(const std::vector<std::uint8_t>&)>& missing) const {
    Flattening flat;
    flat.charts = charts_between(seams_, seam);
    const TriangleMesh open = cut_open(mesh_, flat.charts);
    flat.uv.indices = open.triangles;
    for (const Vec3& p : open.positions) flat.uv.values.push_back({p.x, p.y});
    open_slits(seam, flat.uv);
    SeamState state = measured(seams_, {std::move(flat), {}}, {});
    std::set<std::pair<Index, Index>> edges;
    for (const auto& [a, b, c] : open.triangles)
      for (const auto& edge : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)}) edges.insert(edge);
    const bool is_disk = open.positions.size() + open.triangles.size() == edges.size() + 1;
    const std::vector<Index> wanted = missing(seam);
    for (std::size_t t = 0; t < state.excess.size(); ++t) state.excess[t] = 0.05 * seams_.rest[t].area;
    for (const Index h : wanted) state.excess[h / 3] += 1;
    state.energy = 0;
    for (const double excess : state.excess) state.energy += excess;
    state.distortion = is_disk && wanted.empty() ? 4.05 : 9;
    return state;
  }

  /// Keeps the bound where these are seams.
  MapSeams map_that_needs(const std::vector<std::uint8_t>& needed) const {
    return [this, needed](const std::vector<std::uint8_t>& seam, const SeamState&) {
      return map(seam, [&](const std::vector<std::uint8_t>& tried) {
        std::vector<Index> missing;
        for (Index h = 0; h < needed.size(); ++h)
          if (needed[h] && !tried[h]) missing.push_back(h);
        return missing;
      });
    };
  }

  /// Keeps the bound where a seam reaches this row.
  MapSeams map_that_ends_in(double row) const {
    return [this, row](const std::vector<std::uint8_t>& seam, const SeamState&) {
      return map(seam, [&](const std::vector<std::uint8_t>& tried) {
        for (Index h = 0; h < tried.size(); ++h)
          if (tried[h] && seams_.opposite[h] != k_no_triangle && is_in_row(seams_.to(h), row))
            return std::vector<Index>{};
        return std::vector<Index>{0};
      });
    };
  }
  bool is_in_row(Index v, double row) const { return std::abs(mesh_.positions[v].y - at(0, row).y) < 1e-9; }

  TriangleMesh mesh_;
  std::vector<double> costs_;
  SeamMesh seams_{mesh_, costs_};
};

TEST_F(Sheet, CheapestWaysAreThoseOfTheGrid) {
  CheapestWays ways(seams_);
  const auto vertex = [&](double column, double row) {
    Index found = 0;
    for (Index v = 0; v < mesh_.positions.size(); ++v)
      if (is_at(v, column, row)) found = v;
    return found;
  };
  const Index start = vertex(2, 1), high = vertex(2, 5), wide = vertex(9, 1);
  const auto cost = [&](Index h) { return seams_.length(h); };
  const auto anywhere = [](Index, double) { return true; };
  EXPECT_EQ(ways.search(std::array{start}, cost, anywhere, [&](Index v) { return v == high || v == wide; }), high);
  EXPECT_NEAR(ways.cost(high), 4 * k_high, 1e-12);
  const std::vector<Index> way = ways.way_to(high);
  ASSERT_EQ(way.size(), 4u);
  EXPECT_EQ(seams_.from(way.front()), start);
  EXPECT_EQ(seams_.to(way.back()), high);
  // What a search has found is forgotten by the next, which starts from the nearer of two places.
  EXPECT_EQ(ways.search(std::array{start, vertex(7, 1)}, cost, anywhere, [&](Index v) { return v == wide; }), wide);
  EXPECT_NEAR(ways.cost(wide), 2, 1e-12);
  // A wall over the whole height leaves no way.
  const auto left = [&](Index v, double) { return mesh_.positions[v].x < at(4, 0).x - 1e-9; };
  EXPECT_EQ(ways.search(std::array{start}, cost, left, [&](Index v) { return v == wide; }), CheapestWays::k_none);
  EXPECT_FALSE(ways.has_reached(wide));
}

TEST_F(Sheet, ASlitIsJoinedToTheNearestBorder) {
  // What is needed runs along row 5, two cells below the upper border; it hangs on a cut of five cells from below.
  std::vector<std::uint8_t> needed = borders(), seam;
  cut(needed, at(3, 5), at(8, 5));
  seam = needed;
  cut(seam, at(3, 0), at(3, 5));
  const MapSeams map_seams = map_that_needs(needed);
  const SeamState start = map_seams(seam, {});
  ASSERT_NEAR(start.seam_mm, 5 + 5 * k_high, 1e-9);
  ASSERT_EQ(start.distortion, 4.05);
  std::vector<double> doubt(seam.size(), 1);
  ASSERT_EQ(shorten_seams(seams_, start, {}, map_seams, doubt, {}).seam_mm, start.seam_mm);
  const SeamState result = reconnect_seams(seams_, start, {}, map_seams, map_seams, {});
  EXPECT_NEAR(result.seam_mm, 5 + 2 * k_high, 1e-9);
  EXPECT_EQ(result.distortion, 4.05);
}

TEST_F(Sheet, TwoSlitsThatAreBridgedAreJoinedToTheBorderEach) {
  // Both are needed, at columns 2 and 4 from row 2 to row 5, two cells from the lower and the upper border. A stem of 2
  // from the left border joins the first, a bridge of 2 the second.
  std::vector<std::uint8_t> needed = borders(), seam;
  cut(needed, at(2, 2), at(2, 5));
  cut(needed, at(4, 2), at(4, 5));
  seam = needed;
  cut(seam, at(0, 4), at(2, 4));
  cut(seam, at(2, 3), at(4, 3));
  const MapSeams map_seams = map_that_needs(needed);
  const SeamState start = map_seams(seam, {});
  ASSERT_NEAR(start.seam_mm, 2 * 3 * k_high + 4, 1e-9);
  const SeamState result = reconnect_seams(seams_, start, {}, map_seams, map_seams, {});
  EXPECT_NEAR(result.seam_mm, 2 * 3 * k_high + 2 * 2 * k_high, 1e-9);
  EXPECT_EQ(result.distortion, 4.05);
}

TEST_F(Sheet, ASlitIsJoinedToTheSeamThatLedToIt) {
  // The way to a slit in row 3 passes two rows below it, and all of it up to there is needed. From below its numbers
  // grow along it, from above they fall.
  for (const bool from_above : {false, true}) {
    const auto place = [&](double column, double row) { return at(column, from_above ? k_rows - row : row); };
    std::vector<std::uint8_t> needed = borders(), seam;
    cut(needed, place(2, 0), place(2, 1));
    cut(needed, place(2, 1), place(5, 1));
    cut(needed, place(3, 3), place(5, 3));
    cut(needed, place(5, 3), place(5, 2));
    seam = needed;
    cut(seam, place(5, 1), place(9, 1));
    cut(seam, place(9, 1), place(9, 3));
    cut(seam, place(9, 3), place(5, 3));
    const MapSeams map_seams = map_that_needs(needed);
    const SeamState start = map_seams(seam, {});
    ASSERT_EQ(start.distortion, 4.05);
    ASSERT_NEAR(start.seam_mm, 13 + 4 * k_high, 1e-9);
    const SeamState result = reconnect_seams(seams_, start, {}, map_seams, map_seams, {});
    EXPECT_NEAR(result.seam_mm, 5 + 3 * k_high, 1e-9) << from_above;
  }
}

TEST_F(Sheet, WhatBreaksTheBoundIsLeft) {
  std::vector<std::uint8_t> seam = borders();
  cut(seam, at(3, 0), at(3, 5));
  cut(seam, at(3, 5), at(8, 5));
  const MapSeams map_seams = map_that_needs(seam);
  const SeamState result = reconnect_seams(seams_, map_seams(seam, {}), {}, map_seams, map_seams, {});
  EXPECT_EQ(result.seam, seam);
}

TEST_F(Sheet, MapsThatTurnTrianglesOverAreRefused) {
  // They have a map by the method, so that no chart is said to be without one.
  std::vector<std::uint8_t> seam = borders();
  cut(seam, at(3, 0), at(3, 5));
  const MapSeams map_seams = map_that_needs(borders());
  const SeamState start = map_seams(seam, {});
  ASSERT_TRUE(start.valid);
  const MapSeams turned = [&](const std::vector<std::uint8_t>& tried, const SeamState& nearby) {
    SeamState state = map_seams(tried, nearby);
    state.valid = false;
    state.distortion = std::numeric_limits<double>::infinity();
    state.excess[0] = 1e12;
    return state;
  };
  std::vector<double> doubt(seam.size(), 1);
  EXPECT_EQ(shorten_seams(seams_, start, {}, turned, doubt, {}).seam, seam);
  EXPECT_EQ(reconnect_seams(seams_, start, {}, turned, turned, {}).seam, seam);
}

TEST_F(Sheet, ATipMovesToTheCheaperOfTwoVertices) {
  // A slit from below or from above has to end in the third row, at column 4 or 2 (over a diagonal) or straight on.
  for (const bool from_above : {false, true}) {
    const auto row = [&](double r) { return from_above ? k_rows - r : r; };
    std::vector<std::uint8_t> seam = borders();
    cut(seam, at(3, row(0)), at(3, row(2)));
    Index diagonal = 0;
    for (Index h = 0; h < seam.size(); ++h)
      if (is_at(seams_.from(h), 3, row(2)) && (is_at(seams_.to(h), 4, row(3)) || is_at(seams_.to(h), 2, row(3))))
        diagonal = h;
    ASSERT_GT(seams_.length(diagonal), 1.2);
    seam[diagonal] = seam[seams_.opposite[diagonal]] = 1;
    const MapSeams map_seams = map_that_ends_in(row(3));
    const SeamState start = map_seams(seam, {});
    ASSERT_EQ(start.distortion, 4.05);
    const SeamState result = move_tips(seams_, start, {}, map_seams, map_seams, {});
    EXPECT_NEAR(result.seam_mm, 3 * k_high, 1e-9) << from_above;
  }
}

TEST_F(Sheet, ATipMovesByTwoEdgesWhereOneSavesNothing) {
  // From column 4, where the slit ends in row 3, no edge is shorter than the last; from column 3 the last two are
  // saved.
  std::vector<std::uint8_t> seam = borders();
  cut(seam, at(3, 0), at(3, 2));
  cut(seam, at(3, 2), at(4, 2));
  cut(seam, at(4, 2), at(4, 3));
  const MapSeams map_seams = map_that_ends_in(3);
  const SeamState start = map_seams(seam, {});
  ASSERT_EQ(start.distortion, 4.05);
  ASSERT_NEAR(start.seam_mm, 3 * k_high + 1, 1e-9);
  EXPECT_NEAR(move_tips(seams_, start, {}, map_seams, map_seams, {}).seam_mm, 3 * k_high, 1e-9);
}

}  // namespace
}  // namespace papilla
