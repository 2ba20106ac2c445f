// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/pipeline/studio/studio_document.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"
#include "pipeline/half_opaque.hpp"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;
using Kind = StudioEdit::Kind;

constexpr const char* k_document = R"({"materials": {}, "assign": [], "decals": [
  {"part": "dash*", "picture": "a.png", "at": [0, 0, 0], "size_mm": [8, 4]}, {"picture": "b.png", "not": {"layer": "x"}}]})";

Json edited(const std::string& document, const StudioEdit& edit) {
  return Json::parse(edited_document(document, edit, "m.json"));
}

StudioEdit decal_edit(Kind kind, std::size_t number, const std::map<std::string, std::string>& values = {}) {
  StudioEdit edit;
  edit.kind = kind;
  edit.number = number;
  edit.values = values;
  return edit;
}

SurfaceSelector part(const std::string& name) {
  SurfaceSelector selector;
  selector.part = name;
  return selector;
}

TEST(StudioDecalEdits, ANewOneIsTheLastAndForThePartThatIsNamed) {
  StudioEdit edit = decal_edit(Kind::add_decal, 0, {{"/picture", "\"c.png\""}, {"/height/depth_mm", "0.4"}});
  edit.onto = part("door");
  const Json json = edited(k_document, edit);
  EXPECT_EQ(json["decals"][2], Json::parse(R"({"part": "door", "height": {"depth_mm": 0.4}, "picture": "c.png"})"));
  EXPECT_EQ(json["decals"][0], Json::parse(k_document)["decals"][0]);
  EXPECT_EQ(edited(R"({"materials": {}})", edit)["decals"].size(), 1U);
}

TEST(StudioDecalEdits, ValuesAreOfTheOneThatIsNumbered) {
  const Json json = edited(k_document, decal_edit(Kind::set_decal, 1, {{"/at", "[1,2,3]"}, {"/picture", "\"c.png\""}}));
  EXPECT_EQ(json["decals"][0], Json::parse(k_document)["decals"][0]);
  EXPECT_EQ(json["decals"][1], Json::parse(R"({"picture": "c.png", "not": {"layer": "x"}, "at": [1, 2, 3]})"));
}

TEST(StudioDecalEdits, WhatItIsForIsReplacedAsAWhole) {
  StudioEdit edit = decal_edit(Kind::set_decal, 1);
  edit.onto = part("door");
  EXPECT_EQ(edited(k_document, edit)["decals"][1], Json::parse(R"({"picture": "b.png", "part": "door"})"));
  edit.number = 0;
  edit.onto = SurfaceSelector{};
  EXPECT_FALSE(edited(k_document, edit)["decals"][0].contains("part")) << "for all";
  edit.onto.reset();
  EXPECT_EQ(edited(k_document, edit), Json::parse(k_document)) << "as before";
}

TEST(StudioDecalEdits, TheLastOneLeavesNoListBehind) {
  const Json one = edited(k_document, decal_edit(Kind::remove_decal, 0));
  ASSERT_EQ(one["decals"].size(), 1U);
  EXPECT_EQ(one["decals"][0]["picture"], "b.png");
  EXPECT_FALSE(edited(one.dump(), decal_edit(Kind::remove_decal, 0)).contains("decals"));
}

TEST(StudioDecalEdits, OneThatIsNotThereIsRefused) {
  EXPECT_THROW(edited(k_document, decal_edit(Kind::set_decal, 2)), InvalidInput);
  EXPECT_THROW(edited(k_document, decal_edit(Kind::remove_decal, 2)), InvalidInput);
  EXPECT_THROW(edited(R"({"materials": {}})", decal_edit(Kind::remove_decal, 0)), InvalidInput);
  EXPECT_THROW(edited(R"({"materials": {}, "decals": {}})", decal_edit(Kind::add_decal, 0)), InvalidInput);
  EXPECT_THROW(edited(R"({"materials": {}, "decals": [1]})", decal_edit(Kind::set_decal, 0)), InvalidInput);
}

class StudioDecals : public testing::Test {
 protected:
  StudioDecals() { test::write_half_opaque(folder_.path() / "logo.png"); }

  /// A plate of 4 × 4 squares, 100 mm wide, that looks up, shown twice with 4000 mm between.
  static Scene plates() {
    Part plate;
    plate.name = "plate";
    for (int y = 0; y <= 4; ++y)
      for (int x = 0; x <= 4; ++x) plate.mesh.positions.push_back({25.0 * x, 25.0 * y, 0});
    for (Index y = 0; y < 4; ++y)
      for (Index x = 0; x < 4; ++x) {
        const Index a = 5 * y + x;
        plate.mesh.triangles.insert(plate.mesh.triangles.end(), {{a, a + 1, a + 6}, {a, a + 6, a + 5}});
      }
    plate.materials = {0};
    Scene scene = single_part_scene(std::move(plate), "test");
    scene.up = UpAxis::z;
    scene.nodes[0].name = "left";
    scene.nodes.push_back(scene.nodes[0]);
    scene.nodes[1].name = "right";
    scene.nodes[1].local[3] = 4000;
    scene.roots = {0, 1};
    scene.materials.resize(1);
    scene.materials[0].name = "skin";
    assign_part_ids(scene);
    return scene;
  }

  static Json document(const std::string& more = "") {
    return Json::parse(R"({"materials": {"hard": {"stiffness": 777, "roughness": 0.25}, "soft": {"stiffness": 100}},
      "assign": [{"node": "left", "material": "hard"}, {"node": "right", "material": "soft"}],
      "decals": [{"picture": "logo.png", "at": [50, 50, 0], "direction": [0, 0, -1], "up": [0, 1, 0], "size_mm": [40, 20],
                  "depth_mm": 5)" +
                       more + "}]}");
  }

  StudioPlan plan_of(const StudioScene& studio, const Json& json) const {
    return studio.plan(json.dump(), folder_.path() / "m.json", {});
  }

  /// The first decal of a plan, with its surfaces made.
  static StudioDecal made(StudioScene& studio, const StudioPlan& plan) {
    std::vector<std::shared_ptr<const StudioSurface>> surfaces;
    for (const StudioDecalWish::Below& below : plan.decals.at(0).below) {
      const auto wish = std::find_if(plan.wishes.begin(), plan.wishes.end(),
                                     [&](const StudioWish& w) { return w.key == below.surface; });
      surfaces.push_back(std::make_shared<const StudioSurface>(studio.bake(plan, *wish)));
    }
    return studio.decal(plan, plan.decals[0], surfaces);
  }

  /// Where a place of the picture is on a patch; far away where no vertex has it.
  static Vec3 place_of(const ShownMesh& mesh, float u, float v) {
    for (std::size_t i = 0; 2 * i < mesh.uv.size(); ++i)
      if (mesh.uv[2 * i] == u && mesh.uv[2 * i + 1] == v)
        return {double{mesh.positions[3 * i]}, double{mesh.positions[3 * i + 1]}, double{mesh.positions[3 * i + 2]}};
    return {1e9, 1e9, 1e9};
  }

  static std::vector<float> corners(const ShownMesh& mesh) {
    std::vector<float> places;
    for (const std::uint32_t i : mesh.indices)
      for (std::size_t k = 0; k < 3; ++k) places.push_back(mesh.positions[3 * i + k]);
    return places;
  }

  static BakeOptions options() {
    BakeOptions options;
    options.plan.sides.keep = true;
    return options;
  }

  const TemporaryFolder folder_{"papilla-studio-decals"};
};

TEST_F(StudioDecals, LieWhereTheyAreInTheirSize) {
  StudioScene studio(plates(), options(), false);
  const StudioPlan plan = plan_of(studio, document());
  ASSERT_EQ(plan.decals.size(), 1U);
  ASSERT_EQ(plan.decals[0].below.size(), 1U) << "the other plate is far away";
  EXPECT_EQ(studio.uses()[plan.decals[0].below[0].use].path, "left");
  const StudioDecal decal = made(studio, plan);
  ASSERT_EQ(decal.patches.size(), 1U);
  EXPECT_NEAR(decal.report.area_mm2, 40 * 20, 1e-9);
  const StudioSurface& patch = *decal.patches[0].surface;
  EXPECT_EQ(patch.mm_per_uv, (Vec2{40, 20}));
  // A ten thousandth of the diagonal of the whole scene, not of the plate.
  const double offset = 1e-4 * std::hypot(4100, 100);
  EXPECT_LT(norm(place_of(patch.mesh, 0, 0) - Vec3{30, 40, offset}), 1e-5);
  EXPECT_LT(norm(place_of(patch.mesh, 1, 0) - Vec3{70, 40, offset}), 1e-5);
  EXPECT_LT(norm(place_of(patch.mesh, 1, 1) - Vec3{70, 60, offset}), 1e-5);
  const Material& material = patch.look->materials.at(0);
  EXPECT_EQ(material.roughness, 0.25) << "of the material below";
  EXPECT_EQ(material.alpha_mode, "MASK");
  EXPECT_TRUE(material.base_color_texture);
  EXPECT_FALSE(material.haptic);
}

TEST_F(StudioDecals, AreTurnedByWhatIsUp) {
  StudioScene studio(plates(), options(), false);
  Json json = document();
  json["decals"][0]["up"] = {1, 0, 0};  // Clockwise by a quarter.
  const StudioDecal decal = made(studio, plan_of(studio, json));
  const ShownMesh& mesh = decal.patches.at(0).surface->mesh;
  const double offset = 1e-4 * std::hypot(4100, 100);
  EXPECT_LT(norm(place_of(mesh, 0, 0) - Vec3{40, 70, offset}), 1e-5);
  EXPECT_LT(norm(place_of(mesh, 1, 0) - Vec3{40, 30, offset}), 1e-5);
  EXPECT_LT(norm(place_of(mesh, 0, 1) - Vec3{60, 70, offset}), 1e-5);
}

TEST_F(StudioDecals, AreThoseOfTheBake) {
  StudioScene studio(plates(), options(), false);
  const Json json = document(R"(, "height": {"depth_mm": 0.5, "from": "alpha"}, "metallic": 0.5)");
  const StudioPlan plan = plan_of(studio, json);
  const StudioDecal decal = made(studio, plan);
  const BakeResult baked = bake_scene(plates(), plan.rules, options());
  const auto part =
      std::find_if(baked.scene.parts.begin(), baked.scene.parts.end(), [](const Part& p) { return p.name == "logo"; });
  ASSERT_NE(part, baked.scene.parts.end());
  const StudioSurface& patch = *decal.patches.at(0).surface;
  const ShownMesh expected = shown_mesh(part->mesh);
  EXPECT_EQ(corners(patch.mesh), corners(expected));
  EXPECT_EQ(patch.mesh.uv, expected.uv);
  EXPECT_EQ(patch.mesh.normals, expected.normals);
  const Material& seen = patch.look->materials.at(0);
  const Material& written = baked.scene.materials.at(part->materials.at(0));
  EXPECT_EQ(seen.name, written.name);
  EXPECT_EQ(seen.metallic, 0.5);
  EXPECT_EQ(seen.roughness, written.roughness);
  ASSERT_TRUE(seen.haptic && written.haptic);
  EXPECT_EQ(seen.haptic->stiffness, 777);
  EXPECT_EQ(to_json(*seen.haptic), to_json(*written.haptic));
  const auto bytes = [](const Scene& scene, const std::optional<TextureReference>& reference) {
    return scene.images.at(scene.textures.at(reference.value().texture).image.value()).bytes;
  };
  EXPECT_EQ(bytes(*patch.look, seen.base_color_texture), bytes(baked.scene, written.base_color_texture));
  EXPECT_EQ(bytes(*patch.look, seen.normal_texture), bytes(baked.scene, written.normal_texture));
}

TEST_F(StudioDecals, AreMadeAnewWhereTheyOrWhatTheyLieOnHasChanged) {
  const StudioScene studio(plates(), options(), false);
  const auto key_of = [&](const Json& json) { return plan_of(studio, json).decals.at(0).key; };
  const std::string key = key_of(document());
  Json far_away = document(), below = document(), moved = document(), twice = document();
  far_away["materials"]["soft"]["stiffness"] = 200;
  EXPECT_EQ(key_of(far_away), key);
  below["materials"]["hard"]["roughness"] = 0.5;
  EXPECT_NE(key_of(below), key);
  moved["decals"][0]["at"][0] = 51;
  EXPECT_NE(key_of(moved), key);
  twice["decals"].push_back(moved["decals"][0]);
  EXPECT_EQ(key_of(twice), key);
}

TEST_F(StudioDecals, AreForThePartThatIsNamed) {
  StudioScene studio(plates(), options(), false);
  Json json = document(R"(, "node": "right")");
  EXPECT_TRUE(plan_of(studio, json).decals.at(0).below.empty());
  json["decals"][0]["node"] = "gone";
  EXPECT_NE(plan_of(studio, json).decals.at(0).problem, "");
  const StudioDecal nothing = made(studio, plan_of(studio, json));
  EXPECT_TRUE(nothing.patches.empty());
  EXPECT_EQ(nothing.report.triangles, 0U);
}

TEST_F(StudioDecals, SayWhyNothingIsSeen) {
  StudioScene studio(plates(), options(), false);
  Json json = document();
  json["decals"][0]["direction"] = {0, 0, 1};
  const StudioDecal turned = made(studio, plan_of(studio, json));
  EXPECT_TRUE(turned.patches.empty());
  ASSERT_EQ(turned.warnings.size(), 1U);
  EXPECT_NE(turned.warnings[0].find("turned away"), std::string::npos) << turned.warnings[0];
  json = document();
  json["decals"][0]["picture"] = "gone.png";
  const StudioPlan plan = plan_of(studio, json);
  EXPECT_THROW(made(studio, plan), IoError);
}

TEST_F(StudioDecals, ThePartOfAUseIsNamedSoThatItIsMeantAlone) {
  Scene scene = plates();
  scene.parts.push_back(scene.parts[0]);
  scene.parts[1].name = "lid*";
  scene.nodes[1].part = 1;
  const StudioScene apart(scene, options(), false);
  EXPECT_EQ(apart.selector_of_use(0).part, "plate");
  EXPECT_EQ(apart.selector_of_use(1).part, "lid\\*");
  EXPECT_FALSE(apart.selector_of_use(1).node);
  scene.parts[1].name = "plate";
  const StudioScene alike(scene, options(), false);
  EXPECT_EQ(alike.selector_of_use(1).part, "plate");
  EXPECT_EQ(alike.selector_of_use(1).node, "right");
}

}  // namespace
}  // namespace papilla
