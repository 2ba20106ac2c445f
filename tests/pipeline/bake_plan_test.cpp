// SPDX-License-Identifier: MIT
#include "papilla/pipeline/bake_plan.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/hex_colour.hpp"

namespace papilla {
namespace {

/// A square of 10 mm whose uv runs over `units`.
Part square(const std::string& name, double units) {
  Part part;
  part.name = name;
  part.mesh.positions = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
  part.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  if (units > 0) {
    part.mesh.uv.values = {{0, 0}, {units, 0}, {units, units}, {0, units}};
    part.mesh.uv.indices = part.mesh.triangles;
  }
  return part;
}

Materials rules() {
  Materials file;
  file.materials["grain"].name = "grain";
  file.materials["grain"].texture = "grain.png";
  file.materials["hard"].name = "hard";
  file.materials["hard"].stiffness = 2000;
  AssignRule grain, hard;
  grain.part = "dash*";
  grain.material = "grain";
  hard.part = "knob";
  hard.material = "hard";
  file.assign = {grain, hard};
  return file;
}

TEST(Surfaces, LeaveOutWhatAPartDoesNotNeed) {
  const Materials file = rules();
  Scene scene;
  scene.format = "STL";
  scene.parts = {square("dash", 0), square("knob", 0), square("floor", 0)};
  const auto surfaces = plan_surfaces(scene, assign_materials(scene, file));
  ASSERT_EQ(surfaces.size(), 3U);
  EXPECT_TRUE(decision(surfaces[0].plan, Stage::unwrap).run);
  EXPECT_FALSE(decision(surfaces[1].plan, Stage::unwrap).run);
  EXPECT_TRUE(decision(surfaces[1].plan, Stage::tag).run);
  for (const Decision& stage : surfaces[2].plan) EXPECT_FALSE(stage.run);
}

TEST(Surfaces, MeasureTheScaleOfUsableUv) {
  const Materials file = rules();
  Scene scene;
  scene.parts = {square("dash", 0.25)};
  const auto surfaces = plan_surfaces(scene, assign_materials(scene, file));
  EXPECT_FALSE(decision(surfaces[0].plan, Stage::unwrap).run);
  EXPECT_DOUBLE_EQ(surfaces[0].uv_mm_per_unit, 40);
}

TEST(Surfaces, ReplaceUvThatIsCollapsedStretchedOrNotANumber) {
  const Materials file = rules();
  Scene scene;
  scene.parts = {square("dash 1", 1), square("dash 2", 1), square("dash 3", 1)};
  for (Vec2& uv : scene.parts[0].mesh.uv.values) uv.y = 0;
  for (Vec2& uv : scene.parts[1].mesh.uv.values) uv.y *= 0.1;
  scene.parts[2].mesh.uv.values[2].x = std::numeric_limits<double>::quiet_NaN();
  for (const PartSurface& surface : plan_surfaces(scene, assign_materials(scene, file)))
    EXPECT_TRUE(decision(surface.plan, Stage::unwrap).run) << surface.label << ": " << surface.uv_note;
}

TEST(Surfaces, KeepMirroredUvAndSayHowMuchIs) {
  const Materials file = rules();
  Scene scene;
  scene.parts = {square("dash", 1)};
  scene.parts[0].mesh.uv.values[3] = {1, 0};  // folds the second triangle over the first
  const PartSurface surface = plan_surfaces(scene, assign_materials(scene, file)).at(0);
  EXPECT_FALSE(decision(surface.plan, Stage::unwrap).run);
  EXPECT_DOUBLE_EQ(surface.uv_defects.flipped, 0.5);
  EXPECT_DOUBLE_EQ(surface.uv_defects.degenerate, 0);
  EXPECT_NEAR(surface.uv_defects.overlapping, 1, 1e-3);
  EXPECT_NE(surface.uv_note.find("50 % flipped"), std::string::npos) << surface.uv_note;
}

TEST(Surfaces, DoWithUvAsTheMaterialSays) {
  Materials file = rules();
  Scene scene;
  scene.parts = {square("dash good", 1), square("dash stretched", 1), square("dash none", 0)};
  for (Vec2& uv : scene.parts[1].mesh.uv.values) uv.y *= 0.1;
  const auto unwraps = [&](const std::string& wish) {
    file.materials["grain"].unwrap = wish;
    std::vector<bool> result;
    for (const PartSurface& surface : plan_surfaces(scene, assign_materials(scene, file)))
      result.push_back(decision(surface.plan, Stage::unwrap).run);
    return result;
  };
  EXPECT_EQ(unwraps("auto"), (std::vector{false, true, true}));
  EXPECT_EQ(unwraps("keep"), (std::vector{false, false, true}));
  EXPECT_EQ(unwraps("new"), (std::vector{true, true, true}));
  EXPECT_EQ(unwraps("lscm"), (std::vector{true, true, true}));
}

TEST(Surfaces, SayWhatNewUvCost) {
  Materials file = rules();
  file.materials["grain"].unwrap = "new";
  Scene scene;
  scene.parts = {square("dash", 1)};
  scene.parts[0].materials = {0};
  scene.materials.resize(1);
  scene.materials[0].base_color_texture.emplace();
  scene.materials[0].normal_texture.emplace().tex_coord = 1;
  EXPECT_EQ(plan_surfaces(scene, assign_materials(scene, file)).at(0).lost,
            (std::vector<std::string>{"base colour picture"}));
  EXPECT_TRUE(plan_surfaces(scene, assign_materials(scene, file), {}, true).at(0).lost.empty());
}

TEST(Surfaces, AreNotRepairedInPlace) {
  const Materials file = rules();
  Scene scene;
  scene.parts = {square("dash", 0)};
  EXPECT_TRUE(decision(plan_surfaces(scene, assign_materials(scene, file)).at(0).plan, Stage::repair).run);
  EXPECT_FALSE(decision(plan_surfaces(scene, assign_materials(scene, file), {}, true).at(0).plan, Stage::repair).run);
}

TEST(Surfaces, APartWithTwoMaterialsHasTwoSurfaces) {
  const Materials file = rules();
  Scene scene;
  scene.materials.resize(2);
  scene.materials[0].name = "a";
  scene.materials[1].name = "b";
  scene.parts = {square("dash", 0)};
  scene.parts[0].materials = {1, 0};
  scene.parts[0].mesh.material = {1, 0};
  const auto surfaces = plan_surfaces(scene, assign_materials(scene, file));
  ASSERT_EQ(surfaces.size(), 2U);
  EXPECT_EQ(surfaces[0].label, "dash/b");
  EXPECT_EQ(surfaces[0].triangles, (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(surfaces[1].label, "dash/a");
}

/// A sheet without a side gets a white material; rules are for what the file has.
TEST(Plan, RulesDoNotTakeMaterialsThatTurnedSheetsGet) {
  const test::TemporaryFolder folder;
  // A Moebius strip of three quads: it has one side only.
  folder.write("sheet.off",
               "OFF\n6 6 0\n20 0 5\n20 0 -5\n-10 17 5\n-10 17 -5\n-10 -17 5\n-10 -17 -5\n"
               "3 0 1 2\n3 1 3 2\n3 2 3 4\n3 3 5 4\n3 4 5 1\n3 5 0 1\n");
  for (const bool adds_materials : {false, true})
    for (const auto key : {&SurfaceSelector::gltf_material, &SurfaceSelector::cad_colour}) {
      Materials file = rules();
      file.assign = {{}};
      file.assign[0].*key = key == &SurfaceSelector::cad_colour ? "#ffffff" : "*";
      file.assign[0].material = "hard";
      BakePlanOptions options;
      options.sides.add_materials = adds_materials;
      const BakePlan plan = plan_bake(read_scene(folder / "sheet.off"), file, options);
      EXPECT_EQ(plan.sides.ambiguous, 1U);
      EXPECT_EQ(plan.scene.materials.size(), adds_materials ? 1U : 0U);
      EXPECT_EQ(plan.rules.at(0).surfaces, 0U);
      EXPECT_EQ(plan.surfaces.at(0).material, "");
    }
}

TEST(Plan, StrictErrorsBeginWithTheFileOfTheRules) {
  Materials file = rules();
  file.source = "my rules.json";
  BakePlanOptions options;
  options.strict = true;
  Scene scene;
  scene.parts = {square("floor", 0)};
  const std::string message = test::message_of<InvalidInput>([&] { plan_bake(scene, file, options); });
  EXPECT_TRUE(message.starts_with("my rules.json: rule 1 (/assign/0): ")) << message;
}

TEST(Surfaces, ColoursRoundTripThroughSrgb) {
  for (const std::string hex : {"#000000", "#ffffff", "#20a0c8", "#010203"})
    EXPECT_EQ(hex_colour(linear_colour(hex)), hex);
}

}  // namespace
}  // namespace papilla
