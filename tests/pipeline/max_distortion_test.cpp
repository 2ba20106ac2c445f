// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/param/bounded_seams.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/pipeline/unwrap_method.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

MethodOptions bounded(const std::string& bound, UnwrapMethod method = UnwrapMethod::best) {
  MethodOptions options;
  options.method = method;
  options.max_distortion = distortion_bound(bound);
  EXPECT_TRUE(options.max_distortion) << bound;
  return options;
}

/// Turned about all axes, and scaled.
TriangleMesh placed(TriangleMesh mesh, double scale = 1) {
  const double a = 0.7, b = -1.1, c = 0.4;
  for (Vec3& p : mesh.positions) {
    Vec3 q{p.x, std::cos(a) * p.y - std::sin(a) * p.z, std::sin(a) * p.y + std::cos(a) * p.z};
    q = {std::cos(b) * q.x + std::sin(b) * q.z, q.y, -std::sin(b) * q.x + std::cos(b) * q.z};
    p = scale * Vec3{std::cos(c) * q.x - std::sin(c) * q.y, std::sin(c) * q.x + std::cos(c) * q.y, q.z};
  }
  return mesh;
}

/// An oblong body without symmetries: no map of it is near an isometry.
TriangleMesh pebble(Index rings, Index segments) {
  TriangleMesh mesh = test::uv_sphere(1, rings, segments);
  for (Vec3& p : mesh.positions) {
    const double r = 10 + 1.5 * std::sin(3 * p.x + 2 * p.y) + std::cos(4 * p.z - p.x);
    p = {2.2 * r * p.x, r * p.y, 0.7 * r * p.z};
  }
  return mesh;
}

FlattenedPart unwrapped(const TriangleMesh& mesh, const MethodOptions& options) {
  FlattenedPart part = flatten_part(mesh, {}, options);
  EXPECT_TRUE(part.bound);
  const DistortionReport report = measure_distortion(mesh, part.flattening.uv, {.normalize = UvNormalization::none});
  EXPECT_EQ(report.without_uv + report.flipped + report.degenerate_uv + report.overlapping_within_charts, 0u);
  EXPECT_NEAR(report.seam_length_mm, part.bound->seam_mm, 1e-9 * (1 + part.bound->seam_mm));
  EXPECT_NEAR(bounded_distortion(mesh, part.flattening.uv, *options.max_distortion), part.bound->distortion, 1e-9);
  if (!options.max_distortion->percentile) {
    EXPECT_NEAR(report.symmetric_dirichlet.mean, part.bound->distortion, 1e-6);
  }
  EXPECT_EQ(part.bound->kept, part.bound->distortion <= options.max_distortion->most + k_bound_slack);
  return part;
}

TEST(MaxDistortion, TextsOfBounds) {
  EXPECT_EQ(distortion_bound("4.1")->most, 4.1);
  EXPECT_FALSE(distortion_bound("4")->percentile);
  EXPECT_EQ(distortion_bound("p95=4.25")->most, 4.25);
  EXPECT_EQ(*distortion_bound("p99.5=5")->percentile, 99.5);
  for (const char* bad : {"", "3.9", "nan", "inf", "4.1mm", "p=4.1", "p95", "95=4.1", "p0=4.1", "p101=5", "p95=3"})
    EXPECT_FALSE(distortion_bound(bad)) << bad;
  for (const char* name : {"4.1", "p95=4.25"}) EXPECT_EQ(distortion_bound_name(*distortion_bound(name)), name);
}

TEST(MaxDistortion, ATubeIsCutAlongItOnce) {
  for (const UnwrapMethod method : {UnwrapMethod::best, UnwrapMethod::automatic}) {
    const FlattenedPart part = unwrapped(placed(test::cylinder(30, 80, 24, 6)), bounded("4.0001", method));
    EXPECT_TRUE(part.bound->kept);
    EXPECT_EQ(part.flattening.charts.count, 1u);
    EXPECT_NEAR(part.bound->seam_mm, 80, 1e-6);
  }
}

TEST(MaxDistortion, AConeIsCutFromItsTip) {
  const FlattenedPart part = unwrapped(placed(test::cone(30, 80, 25)), bounded("4.0001"));
  EXPECT_TRUE(part.bound->kept);
  EXPECT_EQ(part.flattening.charts.count, 1u);
  EXPECT_NEAR(part.bound->seam_mm, std::hypot(30, 80), 1e-6);
}

/// For a cap of half angle θ, the energy of the best map tends to 4 + θ⁴ / 48: its area strain w solves Δw = -K and is
/// perpendicular to all harmonic functions, w = K (r² - R² / 2) / 4.
TEST(MaxDistortion, ASmallCapNeedsNoSeam) {
  const double angle = 0.8, least = 4 + std::pow(angle, 4) / 48;
  const TriangleMesh cap = placed(test::spherical_cap(50, angle, 24, 72));
  const FlattenedPart whole = unwrapped(cap, bounded(std::to_string(least + 2e-3)));
  EXPECT_TRUE(whole.bound->kept);
  EXPECT_EQ(whole.bound->seam_mm, 0);
  EXPECT_NEAR(whole.bound->distortion - 4, least - 4, 0.12 * (least - 4));
  const FlattenedPart cut = unwrapped(cap, bounded(std::to_string(4 + 0.5 * (least - 4))));
  EXPECT_TRUE(cut.bound->kept);
  EXPECT_GT(cut.bound->seam_mm, 0);
}

/// Costs of the seams for bounds that get tighter.
std::vector<double> costs_of(const TriangleMesh& mesh) {
  std::vector<double> costs;
  for (const char* bound : {"4.8", "4.2", "4.05", "4.01"}) {
    const FlattenedPart part = unwrapped(mesh, bounded(bound));
    EXPECT_TRUE(part.bound->kept) << bound;
    costs.push_back(part.bound->seam_cost_mm);
  }
  EXPECT_GT(costs.back(), 1.5 * costs.front());
  return costs;
}

TEST(MaxDistortion, ABallIsCutShort) {
  // OptCuts' seams are 3.16 and 3.23 √(A / π) on balls of 3,040 and 760 triangles; here they come out at 3.0 to 3.2, by
  // how the ball is turned. From an icosahedron, as no pole is to help.
  const double t = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh ball;
  ball.positions = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                    {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  ball.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < 3; ++level) {
    std::map<std::pair<Index, Index>, Index> middles;
    std::vector<Triangle> finer;
    const auto middle = [&](Index a, Index b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<Index>(ball.positions.size()));
      if (is_new) ball.positions.push_back(0.5 * (ball.positions[a] + ball.positions[b]));
      return at->second;
    };
    for (const auto& [a, b, c] : ball.triangles) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    ball.triangles.assign(finer.begin(), finer.end());
    for (Vec3& p : ball.positions) p = (1 / norm(p)) * p;
  }
  for (const UnwrapEffort effort : {UnwrapEffort::fast, UnwrapEffort::normal}) {
    MethodOptions options = bounded("4.1");
    options.effort = effort;
    options.segmentation.weigh_seams = false;
    const FlattenedPart part = unwrapped(placed(ball, 5), options);
    EXPECT_TRUE(part.bound->kept);
    EXPECT_EQ(part.flattening.charts.count, 1u);
    EXPECT_LT(part.bound->seam_mm, 3.3 * 2 * 5);  // √(A / π) is twice the radius
  }
}

TEST(MaxDistortion, TighterBoundsGiveNoShorterSeams) {
  const std::vector<double> cap = costs_of(placed(test::spherical_cap(50, 1.5, 20, 60)));
  EXPECT_TRUE(std::is_sorted(cap.begin(), cap.end()));
  // A local search: where seams have many places to go, a tenth is left to chance.
  const std::vector<double> costs = costs_of(pebble(24, 40));
  for (std::size_t i = 1; i < costs.size(); ++i) EXPECT_GE(costs[i], 0.85 * costs[i - 1]) << i;
}

TEST(MaxDistortion, SeamsAreShortForWhatTheyAre) {
  // Of a hemisphere, one straight slit to the top leaves a mean of about 4.09.
  const FlattenedPart part = unwrapped(placed(test::spherical_cap(50, 1.5708, 20, 60)), bounded("4.1"));
  EXPECT_TRUE(part.bound->kept);
  EXPECT_LT(part.bound->seam_mm, 1.3 * 1.5708 * 50);
}

TEST(MaxDistortion, APercentileIsKept) {
  const TriangleMesh mesh = pebble(24, 40);
  const FlattenedPart part = unwrapped(mesh, bounded("p90=4.1"));
  EXPECT_TRUE(part.bound->kept);
  const DistortionReport report = measure_distortion(mesh, part.flattening.uv, {.normalize = UvNormalization::none});
  EXPECT_LE(report.symmetric_dirichlet_percentiles.p90, 4.1 + 1e-5);
  // A local search, as above.
  EXPECT_LT(0.85 * part.bound->seam_cost_mm, unwrapped(mesh, bounded("p99=4.1")).bound->seam_cost_mm);
}

TEST(MaxDistortion, WhatCantBeKeptIsSaid) {
  const FlattenedPart part = unwrapped(test::uv_sphere(20, 40, 60), bounded("4"));
  EXPECT_FALSE(part.bound->kept);
  EXPECT_GT(part.bound->distortion, 4 + k_bound_slack);
}

TEST(MaxDistortion, ScaleAndPlaceDoNotMatter) {
  const FlattenedPart one = unwrapped(pebble(20, 36), bounded("4.1"));
  const FlattenedPart large = unwrapped(placed(pebble(20, 36), 512), bounded("4.1"));
  EXPECT_TRUE(one.bound->kept && large.bound->kept);
  EXPECT_NEAR(large.bound->seam_mm / 512, one.bound->seam_mm, 0.15 * one.bound->seam_mm);
}

/// The half-edges along which charts end.
std::vector<Index> seams_of(const TriangleMesh& mesh, const Flattening& flattening) {
  std::vector<Index> seams;
  const CornerAttribute<Vec2>& uv = flattening.uv;
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (Index o = 0; o < t; ++o)
      for (Index k = 0; k < 3; ++k)
        for (Index m = 0; m < 3; ++m)
          if (mesh.triangles[t][k] == mesh.triangles[o][(m + 1) % 3] &&
              mesh.triangles[t][(k + 1) % 3] == mesh.triangles[o][m] &&
              (uv.indices[t][k] != uv.indices[o][(m + 1) % 3] || uv.indices[t][(k + 1) % 3] != uv.indices[o][m]))
            seams.push_back(3 * t + k);
  return seams;
}

TEST(MaxDistortion, SeamsGoWhereTheEyeDoesNot) {
  const TriangleMesh mesh = test::cylinder(30, 80, 24, 6);
  for (const double side : {-1.0, 1.0}) {
    MethodOptions options = bounded("4.0001");
    options.segmentation.eye = Vec3{side * 900, 20, 40};
    const FlattenedPart part = unwrapped(mesh, options);
    const std::vector<Index> seams = seams_of(mesh, part.flattening);
    ASSERT_FALSE(seams.empty());
    for (const Index h : seams) EXPECT_LT(side * mesh.positions[mesh.triangles[h / 3][h % 3]].x, 5);
    EXPECT_NEAR(part.bound->seam_cost_mm, 0.2 * 80, 8);
  }
}

TEST(MaxDistortion, ItsTraceEndsWithTheResult) {
  const FlattenedPart part = unwrapped(pebble(20, 36), bounded("4.1"));
  ASSERT_GE(part.bound->trace.size(), 3u);
  double seconds = 0;
  bool found = false;
  for (const SeamSample& sample : part.bound->trace) {
    EXPECT_GE(sample.seconds, seconds);
    seconds = sample.seconds;
    EXPECT_TRUE(sample.distortion > 4.1 + k_bound_slack || sample.seam_cost_mm >= part.bound->seam_cost_mm);
    found = found || (sample.seam_mm == part.bound->seam_mm && sample.distortion == part.bound->distortion);
  }
  EXPECT_TRUE(found);
}

TEST(MaxDistortion, SeamsAreSoughtOnACoarseMeshFirst) {
  const TriangleMesh mesh = placed(pebble(40, 64));
  MethodOptions options = bounded("4.1");
  options.effort = UnwrapEffort::best;
  const double on_the_whole = unwrapped(mesh, options).bound->seam_cost_mm;
  for (const UnwrapEffort effort : {UnwrapEffort::normal, UnwrapEffort::fast}) {
    options.effort = effort;
    const FlattenedPart part = unwrapped(mesh, options);
    EXPECT_TRUE(part.bound->kept);
    EXPECT_NEAR(part.bound->seam_cost_mm, on_the_whole, 0.25 * on_the_whole);
    std::size_t coarse = 0, whole = 0;
    bool found = false;
    for (const SeamSample& sample : part.bound->trace) {
      (sample.triangles == mesh.triangles.size() ? whole : coarse) += 1;
      found = found || (sample.triangles == mesh.triangles.size() && sample.seam_mm == part.bound->seam_mm &&
                        sample.distortion == part.bound->distortion);
    }
    EXPECT_TRUE(found);
    EXPECT_GT(coarse, 2 * whole);
    const FlattenedPart again = unwrapped(mesh, options);
    EXPECT_EQ(again.flattening.uv.indices, part.flattening.uv.indices);
  }
}

TEST(MaxDistortion, LittleEffortTriesFewerSeams) {
  const TriangleMesh mesh = placed(pebble(14, 26));  // too small for a coarse mesh
  MethodOptions options = bounded("4.1");
  const FlattenedPart normal = unwrapped(mesh, options);
  options.effort = UnwrapEffort::fast;
  const FlattenedPart fast = unwrapped(mesh, options);
  EXPECT_TRUE(fast.bound->kept);
  EXPECT_LT(fast.bound->trace.size(), normal.bound->trace.size());
  EXPECT_NEAR(fast.bound->seam_cost_mm, normal.bound->seam_cost_mm, 0.25 * normal.bound->seam_cost_mm);
  EXPECT_EQ(fast.bound->trace.back().triangles, mesh.triangles.size());
}

TEST(MaxDistortion, ADevelopablePartNeedsNoMoreSeamsForBeingCoarse) {
  // The triangles of few vertices of a cylinder are not developable, its own are: one cut from end to end is enough.
  // Where it ends on the border is sought on the coarse mesh alone.
  MethodOptions options = bounded("4.0005");
  for (const UnwrapEffort effort : {UnwrapEffort::normal, UnwrapEffort::fast}) {
    options.effort = effort;
    const FlattenedPart part = unwrapped(placed(test::cylinder(30, 80, 96, 24)), options);
    EXPECT_TRUE(part.bound->kept);
    EXPECT_EQ(part.flattening.charts.count, 1u);
    EXPECT_NEAR(part.bound->seam_mm, 80, 5);
  }
}

TEST(MaxDistortion, IsRefusedWhereChartsAreGiven) {
  const TriangleMesh mesh = test::plane(30, 20, 3, 2);
  EXPECT_THROW(flatten_part(mesh, {}, bounded("4.1", UnwrapMethod::lscm)), InvalidInput);
  MethodOptions keep = bounded("4.1");
  keep.charts = ChartSource::keep;
  EXPECT_THROW(flatten_part(mesh, {}, keep), InvalidInput);
  MethodOptions low = bounded("4.1");
  low.max_distortion->most = 3.9;
  EXPECT_THROW(flatten_part(mesh, {}, low), InvalidInput);
}

}  // namespace
}  // namespace papilla
