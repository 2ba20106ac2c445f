// SPDX-License-Identifier: MIT
#include "papilla/core/near_name.hpp"

#include <gtest/gtest.h>

namespace papilla {
namespace {

TEST(NearName, IsFewChangesAway) {
  EXPECT_EQ(did_you_mean("octves", {"octaves", "lacunarity"}), "; did you mean 'octaves'?");
  EXPECT_EQ(did_you_mean("lscn", {"levy", "lscm"}), "; did you mean 'lscm'?");
  EXPECT_EQ(did_you_mean("gearbox", {"levy", "lscm"}), "");
  EXPECT_EQ(did_you_mean("x", {"y"}), "");
}

TEST(NearName, ExchangedLettersAreOneChange) {
  EXPECT_EQ(did_you_mean("ab", {"cd", "ba"}), "; did you mean 'ba'?");
  EXPECT_EQ(did_you_mean("ab", {"cd", "bca"}), "");
}

TEST(NearName, StarsOfAPatternStandForAnyText) {
  EXPECT_EQ(did_you_mean("dahs_*", {"door_panel", "dash_skin"}), "; did you mean 'dash_skin'?");
  EXPECT_EQ(did_you_mean("*_glas?es", {"display_glasses", "rim"}), "; did you mean 'display_glasses'?");
  EXPECT_EQ(did_you_mean("LEATHER*", {"leather_red"}), "; did you mean 'leather_red'?");
}

TEST(NearName, MayContainTheWord) {
  EXPECT_EQ(did_you_mean("cushion", {"rim", "cockpit/seat/cushion"}), "; did you mean 'cockpit/seat/cushion'?");
  EXPECT_EQ(did_you_mean("cu", {"cockpit/seat/cushion"}), "");
  EXPECT_EQ(did_you_mean("Leathr", {"Glass", "Leather_Brown_01"}), "; did you mean 'Leather_Brown_01'?");
  EXPECT_EQ(did_you_mean("cusion*", {"cockpit/seat/cushion_left"}), "; did you mean 'cockpit/seat/cushion_left'?");
  EXPECT_EQ(did_you_mean("seed", {"cockpit/seat/cushion_left"}), "");
}

TEST(NearName, AmongFewNamesTheNearestOneIsNamed) {
  EXPECT_EQ(did_you_mean("bogus", {"plan", "bake", "view"}, 5), "; did you mean 'bake'?");
}

TEST(NearName, IsQuotedOnOneLine) {
  EXPECT_EQ(did_you_mean("two lines", {"two\nlines"}), "; did you mean 'two\\nlines'?");
  EXPECT_EQ(did_you_mean(std::string(300, 'a'), {std::string(300, 'a')}), "");
}

}  // namespace
}  // namespace papilla
