// SPDX-License-Identifier: MIT
#include "papilla/texture/grain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "papilla/core/error.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/symmetry.hpp"

namespace papilla {
namespace {

/// Connected regions (4 neighbours, around the seams) above a height, with the highest point of each.
std::vector<float> elements_above(const HeightMap& map, float level) {
  std::vector<bool> seen(map.mm.size(), false);
  std::vector<float> tops;
  for (std::size_t start = 0; start < map.mm.size(); ++start) {
    if (seen[start] || map.mm[start] <= level) continue;
    std::vector<std::size_t> stack{start};
    seen[start] = true;
    float top = 0;
    while (!stack.empty()) {
      const std::size_t i = stack.back();
      stack.pop_back();
      top = std::max(top, map.mm[i]);
      const int w = map.width, h = map.height, x = static_cast<int>(i) % w, y = static_cast<int>(i) / w;
      for (const std::size_t next : {map.index((x + 1) % w, y), map.index((x + w - 1) % w, y),
                                     map.index(x, (y + 1) % h), map.index(x, (y + h - 1) % h)})
        if (!seen[next] && map.mm[next] > level) {
          seen[next] = true;
          stack.push_back(next);
        }
    }
    tops.push_back(top);
  }
  return tops;
}

TEST(Grain, HasTheSourcesNumberOfElementsOfEqualHeight) {
  const std::map<GrainKind, std::size_t> counts = {{GrainKind::spheres6, 36}, {GrainKind::spheres8, 64},
                                                   {GrainKind::quads6, 36},   {GrainKind::quads8, 64},
                                                   {GrainKind::ovals6, 55},   {GrainKind::ovals8, 85}};
  for (const auto& [kind, count] : counts) {
    const GrainResult grain = synthesize_grain(kind, {400, 40, 0.5});
    const std::vector<float> tops = elements_above(grain.relief, 0.02F);
    EXPECT_EQ(tops.size(), count) << to_string(kind);
    for (const float top : tops) EXPECT_NEAR(top, 0.5, 0.01) << to_string(kind);
  }
}

TEST(Grain, SpheresAreSegmentsOfSpheres) {
  const GrainResult grain = synthesize_grain(GrainKind::spheres6, {600, 60, 1});  // Cells of 10 mm, base radius 4.2 mm.
  const double base = 4.2, radius = (base * base + 1) / 2;
  for (int x = 10; x < 90; ++x) {
    const double rho = std::hypot((x + 0.5) * 0.1 - 5, 0.05);
    const double expected = rho < base ? std::sqrt(radius * radius - rho * rho) - (radius - 1) : 0;
    EXPECT_NEAR(grain.relief.at(x, 50), expected, 0.02) << x;
  }
}

/// 5 columns of 22 mm and 11 rows of 10 mm; the first oval has its centre at (11, 5) mm and half axes of 9.24 and 4.2.
TEST(Grain, OvalsAreSegmentsStretchedToTheirCells) {
  const GrainResult grain = synthesize_grain(GrainKind::ovals6, {1100, 110, 1});
  const double height = 1 / std::sqrt(9.24 * 4.2), radius = (1 + height * height) / (2 * height);
  for (const double share : {-0.9, -0.4, 0.0, 0.6, 0.95}) {
    const double expected = (std::sqrt(radius * radius - share * share) - (radius - height)) / height;
    const auto at = [&](double x_mm, double y_mm) {
      return grain.relief.at(static_cast<int>(std::lround(10 * x_mm - 0.5)),
                             static_cast<int>(std::lround(10 * y_mm - 0.5)));
    };
    EXPECT_NEAR(at(11.05 + 9.24 * share, 5.05), expected, 0.03) << share;
    EXPECT_NEAR(at(11.05, 5.05 + 4.2 * share), expected, 0.05) << share;
  }
}

TEST(Grain, EveryKindFillsTheRangeAndIsRenderedFromItsRelief) {
  for (const std::string_view name : grain_names()) {
    const GrainOptions options{96, 12, 0.4, {-1, -0.5, 1}, 3};
    const GrainResult grain = synthesize_grain(grain_kind(name), options);
    const auto [low, high] = std::minmax_element(grain.relief.mm.begin(), grain.relief.mm.end());
    EXPECT_EQ(*low, 0) << name;
    EXPECT_NEAR(*high, 0.4, 1e-6) << name;
    EXPECT_TRUE(grain.relief.periodic);
    EXPECT_DOUBLE_EQ(grain.relief.pitch_mm_x, 0.125);
    EXPECT_EQ(grain.picture.pixels, render_lambert(grain.relief, options.light).pixels);
    EXPECT_EQ(to_string(grain_kind(name)), name);
  }
}

TEST(Grain, RegularKindsHaveTheirLatticeAndLeatherHasNone) {
  const auto lattice = [](GrainKind kind) { return analyze_symmetry(synthesize_grain(kind, {256}).picture).lattice; };
  const Lattice spheres = lattice(GrainKind::spheres8);
  ASSERT_TRUE(spheres.found);
  EXPECT_NEAR(spheres.vectors_px[0].x, 32, 0.02);
  EXPECT_NEAR(spheres.vectors_px[1].y, 32, 0.02);
  const Lattice ovals = lattice(GrainKind::ovals6);
  ASSERT_TRUE(ovals.found);
  EXPECT_NEAR(std::abs(cross(ovals.vectors_px[0], ovals.vectors_px[1])), 256.0 * 256 / 55, 2);
  EXPECT_FALSE(lattice(GrainKind::leather).found);
}

TEST(Grain, LeatherDependsOnTheSeedAndTilesWithoutSeam) {
  const auto relief = [](std::uint64_t seed) {
    return synthesize_grain(GrainKind::leather, {160, 12, 0.2, {-1, -1, 1}, seed}).relief;
  };
  const HeightMap map = relief(7);
  EXPECT_EQ(map.mm, relief(7).mm);
  EXPECT_NE(map.mm, relief(8).mm);
  float inside = 0, seam = 0;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 159; ++x) inside = std::max(inside, std::abs(map.at(x + 1, y) - map.at(x, y)));
    seam = std::max(seam, std::abs(map.at(0, y) - map.at(159, y)));
  }
  EXPECT_LE(seam, inside);
}

TEST(Grain, RefusesBadOptions) {
  EXPECT_THROW(synthesize_grain(GrainKind::sine, {8}), InvalidInput);
  EXPECT_THROW(synthesize_grain(GrainKind::sine, {64, -1}), InvalidInput);
  EXPECT_THROW(synthesize_grain(GrainKind::sine, {64, 40, 0}), InvalidInput);
  EXPECT_THROW(synthesize_grain(GrainKind::sine, {64, 40, 1, {0, 0, -1}}), InvalidInput);
  EXPECT_THROW(grain_kind("velvet"), InvalidInput);
}

}  // namespace
}  // namespace papilla
