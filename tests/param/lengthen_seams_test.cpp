// SPDX-License-Identifier: MIT
#include "lengthen_seams.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "exchange_seams.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/param/best.hpp"
#include "papilla_test/shapes.hpp"
#include "seam_paths.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// A hemisphere, open below, with a slit along a meridian up from its border. What it is to be cut to is known: as it
/// is the same all around, a slit runs on along its meridian.
class SlitHemisphere : public testing::Test {
 protected:
  SlitHemisphere()
      : mesh_(test::hemisphere_mesh(12, 32, 50)), costs_(3 * mesh_.triangles.size(), 1), seams_(mesh_, costs_) {}

  bool is_on_meridian(Index v) const {
    const Vec3 p = mesh_.positions[v];
    return std::abs(p.y) < 1e-9 && p.x > 1e-9;
  }

  /// Seams as SeamState has them, of a slit up to a height.
  std::vector<std::uint8_t> slit(double height) const {
    std::vector<std::uint8_t> seam;
    for (Index h = 0; h < seams_.opposite.size(); ++h) {
      const bool low = mesh_.positions[seams_.from(h)].z < height && mesh_.positions[seams_.to(h)].z < height;
      seam.push_back(seams_.opposite[h] == k_no_triangle ||
                     (low && is_on_meridian(seams_.from(h)) && is_on_meridian(seams_.to(h))));
    }
    return seam;
  }

  SeamState map(const std::vector<std::uint8_t>& seam, const DistortionBound& bound) const {
    const ChartSet charts = charts_between(seams_, seam);
    BestOptions options;
    options.tolerance = 1e-5;
    return measured(seams_, {flatten_best(cut_open(mesh_, charts), charts, options), {}}, bound);
  }

  TriangleMesh mesh_;
  std::vector<double> costs_;
  SeamMesh seams_;
};

TEST_F(SlitHemisphere, RunsOnAlongItsMeridianUntilTheBoundIsKept) {
  const SeamState low = map(slit(22), {}), high = map(slit(40), {});
  ASSERT_LT(high.distortion, low.distortion);
  const DistortionBound bound{0.5 * (low.distortion + high.distortion), {}};
  int maps = 0;
  const auto state = lengthen_seams(seams_, low, bound,
                                    [&](const auto& seam, const SeamState&) { return ++maps, map(seam, bound); }, {});
  ASSERT_TRUE(state);
  EXPECT_LE(state->distortion, bound.most);
  EXPECT_GT(state->seam_mm, low.seam_mm);
  EXPECT_LE(state->seam_mm, high.seam_mm);
  EXPECT_LE(maps, 5);
  for (Index h = 0; h < state->seam.size(); ++h) {
    if (low.seam[h]) EXPECT_TRUE(state->seam[h]) << h;
    if (!state->seam[h] || seams_.opposite[h] == k_no_triangle) continue;
    EXPECT_TRUE(is_on_meridian(seams_.from(h)) && is_on_meridian(seams_.to(h))) << h;
  }
}

TEST_F(SlitHemisphere, OneLongSlitIsExchangedForTwo) {
  // Two of 4 edges each do less than one of 6, and neither of them can be closed a little.
  std::vector<std::uint8_t> seam = slit(30);
  const auto is_below = [&](Index v) { return mesh_.positions[v].z < 30; };
  const auto is_on_y = [&](Index v) { return std::abs(mesh_.positions[v].x) < 1e-9 && mesh_.positions[v].y > 1e-9; };
  for (Index h = 0; h < seam.size(); ++h)
    if (is_on_y(seams_.from(h)) && is_on_y(seams_.to(h)) && is_below(seams_.from(h)) && is_below(seams_.to(h)))
      seam[h] = 1;
  const SeamState start = map(seam, {});
  const DistortionBound bound{start.distortion, {}};
  const MapSeams map_seams = [&](const auto& tried, const SeamState&) { return map(tried, bound); };
  std::vector<double> doubt(seam.size(), 1);
  EXPECT_EQ(shorten_seams(seams_, start, bound, map_seams, doubt, {}).seam_mm, start.seam_mm);
  const SeamState exchanged = exchange_seams(seams_, start, bound, map_seams, map_seams, {});
  EXPECT_LE(exchanged.distortion, bound.most + k_bound_slack);
  EXPECT_NEAR(exchanged.seam_mm, 0.75 * start.seam_mm, 1e-9);
  EXPECT_EQ(seam_paths(seams_, exchanged.seam).size(), 1U);
}

TEST_F(SlitHemisphere, WithoutSeamsASlitBeginsAtTheBorder) {
  // Laid flat, the equator is stretched by about a third: nowhere else is there tension across a way from the border.
  const SeamState whole = map(slit(-1), {});
  ASSERT_EQ(whole.seam_mm, 0);
  const DistortionBound bound{4 + 0.9 * (whole.distortion - 4), {}};
  const auto state =
      lengthen_seams(seams_, whole, bound, [&](const auto& seam, const SeamState&) { return map(seam, bound); }, {});
  ASSERT_TRUE(state);
  EXPECT_LE(state->distortion, bound.most + k_bound_slack);
  const std::vector<SeamPath> paths = seam_paths(seams_, state->seam);
  ASSERT_FALSE(paths.empty());
  for (const SeamPath& path : paths) {
    EXPECT_NE(path.tip_at_start, path.tip_at_end);
    const auto longitude = [&](Index v) { return std::atan2(mesh_.positions[v].y, mesh_.positions[v].x); };
    for (const Index h : path.halfedges) {
      EXPECT_NE(mesh_.positions[seams_.from(h)].z, mesh_.positions[seams_.to(h)].z);
      EXPECT_NEAR(longitude(seams_.from(h)), longitude(seams_.from(path.halfedges.front())), 1e-9);
    }
  }
}

TEST_F(SlitHemisphere, WhatReleasedNothingIsTakenBackAndTriedElsewhere) {
  // The slit is said to release nothing when it runs on: a new one has to do.
  const SeamState low = map(slit(22), {});
  const DistortionBound bound{4 + 0.97 * (low.distortion - 4), {}};
  int lengthened = 0;
  const auto state =
      lengthen_seams(seams_, low, bound,
                     [&](const auto& seam, const SeamState&) {
                       for (Index h = 0; h < seam.size(); ++h)
                         if (seam[h] && !low.seam[h] && is_on_meridian(seams_.from(h)) && is_on_meridian(seams_.to(h)))
                           return ++lengthened, low;
                       return map(seam, bound);
                     },
                     {});
  ASSERT_TRUE(state);
  EXPECT_GE(lengthened, 1);
  EXPECT_LE(state->distortion, bound.most + k_bound_slack);
  for (Index h = 0; h < low.seam.size(); ++h)
    if (is_on_meridian(seams_.from(h)) && is_on_meridian(seams_.to(h))) {
      EXPECT_EQ(state->seam[h], low.seam[h]) << h;
    }
}

TEST_F(SlitHemisphere, AfterAFewRoundsThatReleaseNothingThereIsNoResult) {
  const SeamState low = map(slit(22), {});
  int maps = 0;
  EXPECT_FALSE(lengthen_seams(seams_, low, {4 + 0.9 * (low.distortion - 4), {}},
                              [&](const auto&, const SeamState&) { return ++maps, low; }, {}));
  EXPECT_EQ(maps, 6);
}

}  // namespace
}  // namespace papilla
