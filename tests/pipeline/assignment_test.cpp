// SPDX-License-Identifier: MIT
#include "papilla/pipeline/assignment.hpp"

#include <gtest/gtest.h>

#include "papilla/core/error.hpp"
#include "papilla/pipeline/bake_plan.hpp"
#include "papilla/pipeline/bake_scene.hpp"

namespace papilla {
namespace {

Part triangle(const std::string& name) {
  Part part;
  part.name = name;
  part.mesh.positions = {{0, 0, 0}, {10, 0, 0}, {0, 20, 0}};
  part.mesh.triangles = {{0, 1, 2}};
  return part;
}

/// cockpit, with two seats of a frame (an unnamed mesh) and a cushion each, which are the same parts, and a dash.
Scene cockpit() {
  Scene scene;
  scene.format = "STEP";
  scene.parts = {triangle("cushion"), triangle(""), triangle("dash_skin")};
  scene.parts[1].mesh.positions[1].x = 30;
  scene.parts[2].mesh.positions[1].x = 40;
  scene.parts[2].extras_json = R"({"layers": ["trim", "visible"], "cad_material": {"name": "PP GF20"}})";
  const auto add = [&](const std::string& name, std::optional<std::uint32_t> part,
                       std::optional<std::uint32_t> parent) {
    Node node;
    node.name = name;
    node.part = part;
    const auto number = static_cast<std::uint32_t>(scene.nodes.size());
    scene.nodes.push_back(node);
    (parent ? scene.nodes[*parent].children : scene.roots).push_back(number);
    return number;
  };
  const std::uint32_t root = add("cockpit", {}, {});
  for (const char* side : {"seat_left", "seat_right"}) {
    const std::uint32_t seat = add(side, {}, root);
    add("cushion", 0, seat);
    add("", 1, seat);
  }
  add("dash", 2, root);
  assign_part_ids(scene);
  return scene;
}

Materials rules_of(std::vector<AssignRule> assign) {
  Materials rules;
  for (const char* name : {"soft", "hard"}) rules.materials[name].name = name;
  rules.materials["soft"].stiffness = 500;
  rules.materials["hard"].stiffness = 2000;
  rules.assign = std::move(assign);
  return rules;
}

AssignRule rule(std::optional<std::string> SurfaceSelector::*field, const std::string& pattern,
                const std::string& material) {
  AssignRule result;
  result.*field = pattern;
  result.material = material;
  return result;
}

/// How many surfaces and uses a rule by one name takes.
std::pair<std::size_t, std::size_t> taken(std::optional<std::string> SurfaceSelector::*field,
                                          const std::string& pattern) {
  Scene scene = cockpit();
  const Materials rules = rules_of({rule(field, pattern, "soft")});
  const RuleUse use = assign_materials(scene, rules).uses.at(0);
  EXPECT_EQ(use.problem.empty(), use.surfaces > 0) << use.problem;
  return {use.surfaces, use.uses};
}

/// What is said of a rule that takes nothing.
std::string problem(const AssignRule& wrong) {
  Scene scene = cockpit();
  const Materials rules = rules_of({wrong});
  return assign_materials(scene, rules).uses.at(0).problem;
}

using Count = std::pair<std::size_t, std::size_t>;
using S = SurfaceSelector;

TEST(Assignment, SelectsByEveryNameThatPeopleSee) {
  EXPECT_EQ(taken(&S::part, "cush*"), (Count{1, 2}));
  EXPECT_EQ(taken(&S::part, "cockpit/seat_left/#1"), (Count{1, 2})) << "an unnamed mesh goes by its path";
  EXPECT_EQ(taken(&S::mesh, "*"), (Count{2, 3})) << "one has no name";
  EXPECT_EQ(taken(&S::node, "cockpit/seat*/cushion"), (Count{1, 2}));
  EXPECT_EQ(taken(&S::node, "cockpit/*"), (Count{1, 1}));
  EXPECT_EQ(taken(&S::node, "**/seat_right/**"), (Count{2, 2}));
  EXPECT_EQ(taken(&S::instance, "#1"), (Count{1, 2}));
  EXPECT_EQ(taken(&S::assembly, "seat_left"), (Count{2, 2}));
  EXPECT_EQ(taken(&S::assembly, "cockpit"), (Count{3, 5}));
  EXPECT_EQ(taken(&S::layer, "vis*"), (Count{1, 1}));
  EXPECT_EQ(taken(&S::cad_material, "PP*"), (Count{1, 1}));
}

TEST(Assignment, LayersAreThoseOfTheNodesAboveToo) {
  Scene scene = cockpit();
  scene.nodes[1].extras_json = R"({"layers": ["left"], "cad_material": {"name": "foam"}})";
  const Materials rules = rules_of({rule(&S::layer, "left", "soft"), rule(&S::cad_material, "foam", "hard")});
  const Assignment assignment = assign_materials(scene, rules);
  EXPECT_EQ(assignment.uses[0].uses, 2U);
  EXPECT_EQ(assignment.uses[1].problem,
            "cad_material 'foam' takes nothing: rules before it take all 2 surfaces that it matches");
}

TEST(Assignment, NotTakesOut) {
  Scene scene = cockpit();
  AssignRule all_but;
  all_but.material = "soft";
  all_but.except.resize(2);
  all_but.except[0].part = "dash*";
  all_but.except[1].node = "**/seat_right/cushion";
  const Materials rules = rules_of({all_but});
  const Assignment assignment = assign_materials(scene, rules);
  EXPECT_EQ(assignment.uses[0].uses, 3U);
  EXPECT_EQ(assignment.parts[2].rule_of(0), nullptr);
}

TEST(Assignment, UsesOfAPartThatGetDifferentMaterialsArePartedAndShownByPath) {
  const Scene before = cockpit();
  const Materials rules =
      rules_of({rule(&S::node, "cockpit/seat_left/cushion", "hard"), rule(&S::part, "cushion", "soft")});
  const BakePlan plan = plan_bake(before, rules);
  ASSERT_EQ(plan.scene.parts.size(), 4U);
  ASSERT_EQ(plan.split.size(), 1U);
  EXPECT_EQ(plan.split[0].part, 3U);
  EXPECT_EQ(plan.split[0].original, 0U);
  EXPECT_EQ(plan.scene.nodes[2].part, 0U);
  EXPECT_EQ(plan.scene.nodes[5].part, 3U);
  EXPECT_EQ(plan.scene.parts[3].name, "cushion");
  EXPECT_EQ(plan.scene.parts[3].mesh.positions, before.parts[0].mesh.positions);
  EXPECT_EQ(plan.surfaces[0].label, "cockpit/seat_left/cushion");
  EXPECT_EQ(plan.surfaces[0].material, "hard");
  EXPECT_EQ(plan.surfaces[1].label, "cockpit/seat_left/#1") << "without a name of its own";
  EXPECT_EQ(plan.surfaces[3].label, "cockpit/seat_right/cushion");
  EXPECT_EQ(plan.surfaces[3].material, "soft");
  const BakeResult baked = bake_scene(before, rules);
  const auto stiffness = [&](std::uint32_t part) {
    return baked.scene.materials.at(baked.scene.parts[part].materials.at(0)).haptic.value().stiffness;
  };
  EXPECT_EQ(stiffness(0), 2000);
  EXPECT_EQ(stiffness(3), 500);
}

TEST(Assignment, PartsThatGetTheSameStayOne) {
  Scene scene = cockpit();
  const Materials rules = rules_of({rule(&S::node, "**/seat_left/cushion", "soft"), rule(&S::part, "cushion", "soft")});
  EXPECT_TRUE(assign_materials(scene, rules).split.empty());
  EXPECT_EQ(scene.parts.size(), 3U);
}

TEST(Assignment, SharedPartsKeepWhatTheyWereAssigned) {
  Scene scene = cockpit();
  scene.parts.push_back(scene.parts[2]);  // A second dash, the same but for its place.
  scene.parts[3].name = "dash_copy";
  scene.nodes.emplace_back();
  scene.nodes.back().name = "copy", scene.nodes.back().part = 3;
  scene.roots.push_back(static_cast<std::uint32_t>(scene.nodes.size() - 1));
  assign_part_ids(scene);
  const Materials rules = rules_of({rule(&S::instance, "copy", "soft"), rule(&S::node, "cockpit/dash", "soft")});
  const BakePlan plan = plan_bake(scene, rules);
  ASSERT_EQ(plan.shared.size(), 1U);
  EXPECT_EQ(plan.shared[0].number, 3U);
  EXPECT_EQ(plan.surfaces.at(2).material, "soft");
  EXPECT_EQ(plan.rules[0].surfaces, 1U);
  EXPECT_EQ(plan.rules[1].surfaces, 1U);
}

TEST(Assignment, ARuleThatTakesNothingSaysWhyWithANearName) {
  EXPECT_EQ(problem(rule(&S::part, "dahs_*", "soft")), "part 'dahs_*' matches nothing; did you mean 'dash_skin'?");
  EXPECT_EQ(problem(rule(&S::node, "seat_left/cushion", "soft")),
            "node 'seat_left/cushion' matches nothing; did you mean '**/seat_left/cushion'?");
  EXPECT_EQ(problem(rule(&S::node, "cockpit/seta_left/cushion", "soft")),
            "node 'cockpit/seta_left/cushion' matches nothing; did you mean 'cockpit/seat_left/cushion'?");
  EXPECT_EQ(problem(rule(&S::layer, "visibel", "soft")), "layer 'visibel' matches nothing; did you mean 'visible'?");
  EXPECT_EQ(problem(rule(&S::gltf_material, "x", "soft")), "gltf_material 'x' matches nothing; the scene has none");
  EXPECT_EQ(problem(rule(&S::node, "**/seat_lfet/cushion*", "soft")),
            "node '**/seat_lfet/cushion*' matches nothing; did you mean 'cockpit/seat_left/cushion'?");
  EXPECT_EQ(problem(rule(&S::node, "**/seat_lfet/upholstery/seam*", "soft")),
            "node '**/seat_lfet/upholstery/seam*' matches nothing; did you mean 'seat_left'?");
  EXPECT_EQ(problem(rule(&S::node, "**/tray*", "soft")), "node '**/tray*' matches nothing");
  AssignRule both = rule(&S::part, "cushion", "soft");
  both.layer = "trim";
  EXPECT_EQ(problem(both), "part 'cushion', layer 'trim' matches nothing together");
  both.layer.reset();
  both.except.resize(1);
  both.except[0].assembly = "cockpit";
  EXPECT_EQ(problem(both), "part 'cushion', not assembly 'cockpit' leaves nothing");
}

TEST(Assignment, ProblemsAreWarningsAndErrorsWhenStrict) {
  const Materials rules = rules_of({rule(&S::part, "cushion", "soft"), rule(&S::part, "dahs*", "hard")});
  const BakePlan plan = plan_bake(cockpit(), rules);
  ASSERT_EQ(plan.scene.warnings.size(), 1U);
  EXPECT_EQ(plan.scene.warnings[0], "rule 2 (/assign/1): part 'dahs*' matches nothing; did you mean 'dash_skin'?");
  BakePlanOptions strict;
  strict.strict = true;
  EXPECT_THROW(plan_bake(cockpit(), rules, strict), InvalidInput);
}

TEST(Assignment, PartsThatNothingShowsAreSelectedByTheirNames) {
  Scene scene;
  scene.parts = {triangle("dash")};
  const Materials rules = rules_of({rule(&S::part, "dash", "soft"), rule(&S::node, "**", "hard")});
  const Assignment assignment = assign_materials(scene, rules);
  EXPECT_EQ(assignment.parts.at(0).rule_of(0)->name, "soft");
  EXPECT_EQ(assignment.uses[1].problem, "node '**' matches nothing; the scene has none");
}

}  // namespace
}  // namespace papilla
