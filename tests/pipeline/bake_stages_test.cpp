// SPDX-License-Identifier: MIT
#include "papilla/pipeline/bake_stages.hpp"

#include <gtest/gtest.h>

namespace papilla {
namespace {

TEST(Plan, ASurfaceWithoutMaterialNeedsNothing) {
  const SurfacePlan plan = make_plan({}, {});
  for (const Decision& stage : plan) {
    EXPECT_FALSE(stage.run);
    EXPECT_FALSE(stage.reason.empty());
  }
}

TEST(Plan, HapticConstantsWithoutGrainNeedOnlyTheTag) {
  const SurfacePlan plan = make_plan({.grain = false, .feel = true}, {});
  for (const StageRule& rule : k_stages)
    EXPECT_EQ(decision(plan, rule.stage).run, rule.stage == Stage::tag) << rule.name;
}

TEST(Plan, GrainWithoutUvRunsEverythingButTessellation) {
  const SurfacePlan plan = make_plan({.grain = true, .feel = true}, {});
  for (const StageRule& rule : k_stages)
    EXPECT_EQ(decision(plan, rule.stage).run, rule.stage != Stage::tessellate) << rule.name;
}

TEST(Plan, UsableUvIsKept) {
  const SurfacePlan plan = make_plan({.grain = true, .feel = true}, {.cad = false, .uv = UvState::usable});
  for (const Stage stage : {Stage::repair, Stage::charts, Stage::unwrap}) {
    EXPECT_FALSE(decision(plan, stage).run);
    EXPECT_NE(decision(plan, stage).reason.find("kept"), std::string_view::npos);
  }
  EXPECT_TRUE(decision(plan, Stage::measure).run);
  EXPECT_TRUE(decision(plan, Stage::height).run);
}

TEST(Plan, UnusableUvIsReplaced) {
  EXPECT_TRUE(
      decision(make_plan({.grain = true, .feel = true}, {.cad = false, .uv = UvState::unusable}), Stage::unwrap).run);
}

TEST(Plan, OnlyMeshesWithDefectsAreRepaired) {
  EXPECT_FALSE(decision(make_plan({.grain = true, .feel = true}, {.is_clean = true}), Stage::repair).run);
  EXPECT_TRUE(decision(make_plan({.grain = true, .feel = true}, {.is_clean = true}), Stage::unwrap).run);
}

TEST(Plan, OnlyCadIsTessellated) {
  EXPECT_TRUE(decision(make_plan({}, {.cad = true}), Stage::tessellate).run);
  EXPECT_FALSE(decision(make_plan({}, {.cad = false}), Stage::tessellate).run);
}

static_assert(!decision(make_plan({}, {.cad = true}), Stage::unwrap).run, "the table is usable at compile time");

}  // namespace
}  // namespace papilla
