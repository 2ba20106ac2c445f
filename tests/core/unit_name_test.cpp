// SPDX-License-Identifier: MIT
#include "papilla/core/unit_name.hpp"

#include <gtest/gtest.h>

#include "papilla/core/units.hpp"

namespace papilla {
namespace {

TEST(UnitName, KnowsTheUsualOnes) {
  EXPECT_EQ(unit_name(1), "mm");
  EXPECT_EQ(unit_name(1000), "m");
  EXPECT_EQ(unit_name(25.4), "in");
  EXPECT_EQ(unit_name(k_mm_per_inch), "in");
  EXPECT_EQ(unit_name(k_mm_per_metre), "m");
  EXPECT_EQ(unit_name(304.8), "ft");
}

TEST(UnitName, IsTheLengthOtherwise) {
  EXPECT_EQ(unit_name(2.5), "2.5 mm");
  EXPECT_EQ(unit_name(1e-9), "1e-09 mm");
}

}  // namespace
}  // namespace papilla
