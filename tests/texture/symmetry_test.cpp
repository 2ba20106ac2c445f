// SPDX-License-Identifier: MIT
#include "papilla/texture/symmetry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "papilla/core/error.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"
#include "texture/wallpaper_patterns.hpp"

namespace papilla {
namespace {

constexpr int k_groups = 17;

struct Count {
  int lattices = 0, groups = 0;
};

Count count(const test::PhotoConditions& photo) {
  Count count;
  for (int i = 0; i < k_groups; ++i) {
    const auto group = static_cast<WallpaperGroup>(i);
    const test::WallpaperPattern pattern =
        test::photographed_pattern(group, 400 + static_cast<unsigned>(i), photo, 224);
    const SymmetryAnalysis analysis = analyze_symmetry(pattern.image);
    if (!analysis.lattice.found) continue;
    const double cell = std::sqrt(std::abs(cross(pattern.a, pattern.b)));
    const bool right = test::lattice_error(analysis.lattice.vectors_px, pattern.a, pattern.b) < 0.05 * cell;
    count.lattices += right;
    count.groups += right && find_wallpaper_group(analysis).group == group;
  }
  return count;
}

TEST(Symmetry, FollowsLatticesBentByATwentiethOfTheCell) {
  const Count found = count(test::k_bent_photo);
  EXPECT_GE(found.lattices, 16);
  EXPECT_GE(found.groups, 15);
}

TEST(Symmetry, FollowsLatticesBentByATenthOfTheCell) {
  const Count found = count(test::k_badly_bent_photo);
  EXPECT_GE(found.lattices, 13);
  EXPECT_GE(found.groups, 11);
}

TEST(Symmetry, ExactLatticesDoNotBend) {
  for (const double noise : {0.0, 1.0}) {
    const test::WallpaperPattern pattern = test::wallpaper_pattern(WallpaperGroup::p4g, 11, noise, 200);
    const SymmetryAnalysis analysis = analyze_symmetry(pattern.image);
    ASSERT_TRUE(analysis.lattice.found);
    EXPECT_FALSE(analysis.deformation);
    EXPECT_LT(analysis.false_alarm_probability, 1e-3);
    EXPECT_EQ(analysis.lattice.vectors_px, find_lattice(analysis.matrix).vectors_px);
  }
}

TEST(Symmetry, NoiseHasNoLattice) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    EXPECT_FALSE(analyze_symmetry(test::noise_image(150, 110, static_cast<unsigned>(seed))).lattice.found);
    const SymmetryAnalysis surface = analyze_symmetry(to_grey_image(brownian_surface_exact({129, 0.4, seed}), 8));
    EXPECT_FALSE(surface.lattice.found);
    EXPECT_GT(surface.false_alarm_probability, 0.01);
    EXPECT_EQ(surface.lattice.reason, "no wave stands out of the spectrum");
    EXPECT_TRUE(surface.matrix.distortion.empty());
  }
}

TEST(Symmetry, NothingIsSkippedWhereALatticeIsForced) {
  const GreyImage noise = test::noise_image(150, 110, 3);
  EXPECT_TRUE(analyze_symmetry(noise).matrix.distortion.empty());
  EXPECT_FALSE(analyze_symmetry(noise, {.false_alarm_rate = 1}).matrix.distortion.empty());
}

TEST(Symmetry, RefusesBadArguments) {
  EXPECT_THROW(analyze_symmetry(test::noise_image(32, 32, 1), {.false_alarm_rate = 0}), InvalidInput);
  EXPECT_THROW(find_wallpaper_group(analyze_symmetry(test::noise_image(32, 32, 1))), InvalidInput);
}

}  // namespace
}  // namespace papilla
