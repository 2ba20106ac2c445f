// SPDX-License-Identifier: MIT
#include "shift_seams.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "drawn_seams.hpp"
#include "papilla_test/shapes.hpp"
#include "seam_paths.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// A long strip cut in two charts by a seam along it. What its maps are good for is said by each test: the energy of a
/// triangle by its chart and place.
class CutStrip : public testing::TestWithParam<bool> {
 protected:
  static constexpr int k_across = 12, k_along = 40;
  static constexpr double k_wide = 0.9;

  /// The strip runs along y, or along x.
  CutStrip()
      : along_x_(GetParam()),
        mesh_(along_x_ ? test::plane(k_along, k_across * k_wide, k_along, k_across)
                       : test::plane(k_across * k_wide, k_along, k_across, k_along)),
        costs_(3 * mesh_.triangles.size()) {
    const Vec3 corner = mesh_.positions[0];
    for (Vec3& p : mesh_.positions) p = p - corner;
    const SeamMesh plain(mesh_, costs_);
    for (Index h = 0; h < costs_.size(); ++h) costs_[h] = plain.length(h);
  }

  Vec3 at(double across, double along) const {
    return along_x_ ? Vec3{along, across * k_wide, 0} : Vec3{across * k_wide, along, 0};
  }
  /// In cells.
  double across(Vec3 p) const { return (along_x_ ? p.y : p.x) / k_wide; }
  double along(Vec3 p) const { return along_x_ ? p.x : p.y; }

  /// @param low, high e - 4 near the seam, in the chart of the lower `across` and in the other one; little elsewhere.
  /// @param most D - 4 for an energy of 1.
  SeamState map(const std::vector<std::uint8_t>& seam, double low, double high, double most) const {
    Flattening flat;
    flat.charts = charts_between(seams_, seam);
    flat.uv.indices = mesh_.triangles;
    for (std::uint32_t chart = 0; chart < flat.charts.count; ++chart)  // They lie apart.
      for (const Vec3& p : mesh_.positions) flat.uv.values.push_back({p.x + 100 * chart, p.y});
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (Index& v : flat.uv.indices[t]) v += flat.charts.of_triangle[t] * static_cast<Index>(mesh_.positions.size());
    SeamState state = measured(seams_, {std::move(flat), {}}, {});
    const std::uint32_t first = state.charted.flattening.charts.of_triangle[corner_triangle()];
    state.energy = 0;
    for (std::size_t t = 0; t < state.excess.size(); ++t) {
      const bool is_low = state.charted.flattening.charts.of_triangle[t] == first;
      const Vec3 a = mesh_.positions[mesh_.triangles[t][0]], b = mesh_.positions[mesh_.triangles[t][1]],
                 c = mesh_.positions[mesh_.triangles[t][2]];
      const bool is_near = std::abs(across((1.0 / 3) * (a + b + c)) - 6) < 3;
      state.energy += state.excess[t] = seams_.rest[t].area * (is_near ? (is_low ? low : high) : 1e-3);
    }
    state.distortion = 4 + most * state.energy;
    return state;
  }
  /// One at the lowest `across`.
  std::size_t corner_triangle() const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const Index v : mesh_.triangles[t])
        if (norm(mesh_.positions[v]) < 1e-9) return t;
    return 0;
  }

  /// The seam's place across, half way along the strip.
  double middle(const std::vector<std::uint8_t>& seam) const {
    for (Index h = 0; h < seam.size(); ++h)
      if (seam[h] && seams_.opposite[h] != k_no_triangle && along(mesh_.positions[seams_.from(h)]) == k_along / 2)
        return across(mesh_.positions[seams_.from(h)]);
    return -1;
  }

  bool along_x_;
  TriangleMesh mesh_;
  std::vector<double> costs_;
  SeamMesh seams_{mesh_, costs_};
};

TEST_P(CutStrip, ASeamIsMovedToTheSideOfMoreEnergy) {
  for (const bool to_high : {false, true}) {
    std::vector<std::uint8_t> seam = test::border_seams(seams_);
    test::draw_seam(seams_, seam, at(6, 0), at(6, k_along));
    const double low = to_high ? 0.02 : 0.3, high = to_high ? 0.3 : 0.02;
    const SeamState start = map(seam, low, high, 1);
    std::vector<SeamState> tried;
    const MapSeams map_seams = [&](const auto& next, const SeamState&) {
      tried.push_back(map(next, low, high, 1));
      SeamState state = tried.back();
      state.distortion = 9;
      return state;
    };
    EXPECT_EQ(shift_seams(seams_, start, {4.1, {}}, map_seams, map_seams, {}).seam, seam);  // it breaks the bound
    ASSERT_EQ(tried.size(), 1u);
    // All that changes sides has the density of the other side then, so that what is least is known.
    const auto value = [&](const SeamState& state) {
      return state.energy + 4 * start.energy / start.cost_mm * state.cost_mm;
    };
    EXPECT_LT(value(tried[0]), value(start));
    for (const double moved : {1, 2}) {
      const double to = 6 + (to_high ? moved : -moved);
      std::vector<std::uint8_t> other = test::border_seams(seams_);
      test::draw_seam(seams_, other, at(6, 0), at(6, 2));
      test::draw_seam(seams_, other, at(6, 2), at(to, 2));
      test::draw_seam(seams_, other, at(to, 2), at(to, k_along - 2));
      test::draw_seam(seams_, other, at(to, k_along - 2), at(6, k_along - 2));
      test::draw_seam(seams_, other, at(6, k_along - 2), at(6, k_along));
      EXPECT_LE(value(tried[0]), value(map(other, low, high, 1)) + 1e-9);
    }
    EXPECT_NEAR(middle(tried[0].seam), to_high ? 8 : 4, 1e-9);
    const std::vector<SeamPath> paths = seam_paths(seams_, tried[0].seam);
    ASSERT_EQ(paths.size(), 1u);
    const Index a = seams_.from(paths[0].halfedges.front()), b = seams_.to(paths[0].halfedges.back());
    for (const double end : {0.0, double(k_along)})
      EXPECT_TRUE(norm(mesh_.positions[a] - at(6, end)) < 1e-9 || norm(mesh_.positions[b] - at(6, end)) < 1e-9);
  }
}

TEST_P(CutStrip, WhereBothSidesAreAlikeADetourIsCutOff) {
  std::vector<std::uint8_t> seam = test::border_seams(seams_);
  test::draw_seam(seams_, seam, at(6, 0), at(6, 10));
  test::draw_seam(seams_, seam, at(6, 10), at(8, 10));
  test::draw_seam(seams_, seam, at(8, 10), at(8, 20));
  test::draw_seam(seams_, seam, at(8, 20), at(6, 20));
  test::draw_seam(seams_, seam, at(6, 20), at(6, k_along));
  const MapSeams map_seams = [&](const auto& tried, const SeamState&) {
    SeamState state = map(tried, 0.1, 0.1, 0);
    state.distortion = charts_between(seams_, tried).count < 2 ? 9 : 4.05;
    return state;
  };
  const SeamState start = map_seams(seam, {});
  ASSERT_NEAR(start.seam_mm, k_along + 4 * k_wide, 1e-9);
  const SeamState result = shift_seams(seams_, start, {4.1, {}}, map_seams, map_seams, {});
  EXPECT_NEAR(result.seam_mm, k_along, 1e-9);
  EXPECT_NEAR(middle(result.seam), 6, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(AlongBothAxes, CutStrip, testing::Bool());

}  // namespace
}  // namespace papilla
