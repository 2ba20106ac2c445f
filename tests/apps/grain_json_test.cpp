// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "json/scene_json.hpp"

namespace papilla::app {
namespace {

/// A grain of 30 by 45 mm that repeats obliquely.
TEST(GrainJson, TellsBothSidesOfTheRepeatAndBothNumbersOfItsPeriods) {
  Grain grain;
  grain.size_mm[0] = 30;
  grain.size_mm[1] = 45;
  grain.photograph_mm = {60, 135};
  grain.lattice.emplace();
  grain.lattice->period_mm = {Vec2{5, 1}, Vec2{-2, 9}};
  const Json json = grain_json("hide", grain);
  EXPECT_EQ(json["picture"]["size_mm"], Json({30, 45}));
  EXPECT_EQ(json["picture"]["shows_mm"], Json({60, 135}));
  EXPECT_EQ(json["period_mm"], Json::parse("[[5, 1], [-2, 9]]"));
}

TEST(ContactModelsJson, DepthsAreInMillimetres) {
  Materials rules;
  rules.materials["seat"].backing = BackingTag{250, 0.004};
  const Json json = contact_models_json(rules);
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["backing"]["stiffness"], 250);
  EXPECT_DOUBLE_EQ(json[0]["backing"]["depth_mm"].get<double>(), 4);
}

}  // namespace
}  // namespace papilla::app
