// SPDX-License-Identifier: MIT
#include "papilla/texture/wallpaper_group.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "papilla/core/error.hpp"
#include "papilla/texture/symmetry.hpp"
#include "texture/fixtures.hpp"
#include "texture/wallpaper_patterns.hpp"

namespace papilla {
namespace {

constexpr int k_groups = 17;
/// Order of the point group, as the International Tables list it.
constexpr std::array<int, k_groups> k_orders = {1, 2, 2, 2, 2, 4, 4, 4, 4, 4, 8, 8, 3, 6, 6, 6, 12};

double area(const std::vector<Vec2>& corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) twice += cross(corners[i], corners[(i + 1) % corners.size()]);
  return std::abs(twice) / 2;
}

class AllGroups : public testing::TestWithParam<double> {};

TEST_P(AllGroups, AreFoundFromThePicture) {
  for (int i = 0; i < k_groups; ++i) {
    const auto group = static_cast<WallpaperGroup>(i);
    const test::WallpaperPattern pattern =
        test::wallpaper_pattern(group, 3 + static_cast<unsigned>(i), GetParam(), 192);
    const SymmetryAnalysis analysis = analyze_symmetry(pattern.image);
    ASSERT_TRUE(analysis.lattice.found) << to_string(group);
    EXPECT_LT(test::lattice_error(analysis.lattice.vectors_px, pattern.a, pattern.b), 0.2) << to_string(group);
    const WallpaperSymmetry found = find_wallpaper_group(*analysis.part, analysis.lattice.vectors_px);
    EXPECT_EQ(to_string(found.group), to_string(group));
    EXPECT_EQ(found.order, k_orders[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(area(found.region_px) * found.order,
                std::abs(cross(analysis.lattice.vectors_px[0], analysis.lattice.vectors_px[1])),
                0.02 * std::abs(cross(pattern.a, pattern.b)));
  }
}

INSTANTIATE_TEST_SUITE_P(Noise, AllGroups, testing::Values(0.0, 1.0));

TEST(WallpaperGroup, AveragingKeepsWhatTheGroupShares) {
  const test::WallpaperPattern pattern = test::wallpaper_pattern(WallpaperGroup::p4, 5, 0, 192);
  const SymmetryAnalysis analysis = analyze_symmetry(pattern.image);
  const WallpaperSymmetry found = find_wallpaper_group(*analysis.part, analysis.lattice.vectors_px);
  EXPECT_GT(found.kept, 0.995);
  double difference = 0, square = 0, mean = 0;
  const Values<float>&before = analysis.part->primitive.pixels, &after = found.primitive.pixels;
  ASSERT_EQ(before.size(), after.size());
  for (const float grey : before) mean += static_cast<double>(grey) / static_cast<double>(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    difference += std::pow(static_cast<double>(before[i]) - static_cast<double>(after[i]), 2);
    square += std::pow(static_cast<double>(before[i]) - mean, 2);
  }
  EXPECT_LT(difference, 0.02 * square);
  // p1 keeps everything, and every other group less than what it is a subgroup of.
  for (const WallpaperCandidate& candidate : found.candidates)
    if (candidate.group == WallpaperGroup::p1) {
      EXPECT_NEAR(candidate.kept, 1, 1e-12);
    } else if (candidate.group == WallpaperGroup::p4m) {
      EXPECT_LT(candidate.kept, found.kept);
    }
}

TEST(WallpaperGroup, OriginIsARotationCentre) {
  // cos u + cos v about (5.25, 3.5): a centre of the fourfold rotation there or half a cell further.
  const GreyImage image = test::make_image(160, 160, [](int x, int y) {
    const double k = 2 * 3.141592653589793 / 20;
    return 0.5 + 0.2 * std::cos(k * (x - 5.25)) + 0.2 * std::cos(k * (y - 3.5));
  });
  const SymmetryAnalysis analysis = analyze_symmetry(image);
  ASSERT_TRUE(analysis.lattice.found);
  const WallpaperSymmetry found = find_wallpaper_group(*analysis.part, analysis.lattice.vectors_px);
  EXPECT_EQ(found.group, WallpaperGroup::p4m);
  const auto off = [](double value, double centre) { return std::abs(std::remainder(value - centre, 10)); };
  EXPECT_LT(off(found.origin_px.x, 5.25), 0.1);
  EXPECT_LT(off(found.origin_px.y, 3.5), 0.1);
}

TEST(WallpaperGroup, FlatCellHasNone) {
  SymmetricPart part;
  part.primitive = part.residual = test::make_image(16, 16, [](int, int) { return 0.25; });
  const WallpaperSymmetry found = find_wallpaper_group(part, {Vec2{16, 0}, Vec2{0, 16}});
  EXPECT_EQ(found.group, WallpaperGroup::p1);
  EXPECT_EQ(found.order, 1);
}

TEST(WallpaperGroup, RefusesBadArguments) {
  SymmetricPart part;
  EXPECT_THROW(find_wallpaper_group(part, {Vec2{16, 0}, Vec2{0, 16}}), InvalidInput);
  part.primitive = part.residual = test::noise_image(16, 16, 1);
  EXPECT_THROW(find_wallpaper_group(part, {Vec2{16, 0}, Vec2{32, 0}}), InvalidInput);
  EXPECT_THROW(find_wallpaper_group(part, {Vec2{16, 0}, Vec2{0, std::numeric_limits<double>::infinity()}}),
               InvalidInput);
  EXPECT_THROW(find_wallpaper_group(part, {Vec2{16, 0}, Vec2{0, 16}}, {0, 0.03}), InvalidInput);
}

}  // namespace
}  // namespace papilla
