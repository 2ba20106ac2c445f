// SPDX-License-Identifier: MIT
#include "papilla/pipeline/scene_sides.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/temporary_folder.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/repair_scene.hpp"
#include "papilla/pipeline/unwrap_scene.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla_test/shapes.hpp"
#include "pipeline/room_fixture.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

using test::add_part;
using test::room;
using test::turn_all;

const PartSides* sides_of(const SceneSides& sides, const std::string& part) {
  const auto found =
      std::find_if(sides.parts.begin(), sides.parts.end(), [&](const PartSides& p) { return p.part == part; });
  return found == sides.parts.end() ? nullptr : &*found;
}

Vec3 first_normal(const Part& part) {
  const TriangleMesh& m = part.mesh;
  return normalized(cross(m.corner(0, 1) - m.corner(0, 0), m.corner(0, 2) - m.corner(0, 0)));
}

const Part& part_named(const Scene& scene, const std::string& name) {
  return *std::find_if(scene.parts.begin(), scene.parts.end(), [&](const Part& p) { return p.name == name; });
}

TEST(SceneSides, WallsAreTurnedAndStayTurned) {
  Scene scene = room();
  turn_all(scene.parts[3].mesh);
  const SceneSides counted = find_sides(scene);
  EXPECT_EQ(counted.open_components, 6u);
  EXPECT_EQ(counted.facing_away, 1u);
  EXPECT_EQ(first_normal(scene.parts[3]), (Vec3{1, 0, 0}));
  const SceneSides sides = turn_sheets(scene);
  EXPECT_EQ(sides.viewpoint, Viewpoint::room);
  EXPECT_EQ(sides_of(sides, "right")->facing_away, 1u);
  EXPECT_EQ(sides_of(sides, "right")->turned_triangles, 32u);
  EXPECT_EQ(sides.facing_away, 1u);
  EXPECT_EQ(sides.ambiguous, 0u);
  EXPECT_EQ(first_normal(scene.parts[3]), (Vec3{-1, 0, 0}));
  EXPECT_FALSE(scene.materials[0].double_sided);
  EXPECT_EQ(turn_sheets(scene).facing_away, 0u);

  turn_all(scene.parts[3].mesh);
  EXPECT_EQ(turn_sheets(scene, {.keep = true, .inside = {}}).open_components, 0u);
  EXPECT_EQ(first_normal(scene.parts[3]), (Vec3{1, 0, 0}));
}

/// Whatever is up, an eye that is given is where it was given, in the axes of the scene.
TEST(SceneSides, AnEyeIsToldInTheAxesOfTheScene) {
  for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
    Scene scene = room();
    scene.up = up;
    turn_all(scene.parts[5].mesh);
    const SceneSides sides = find_sides(scene, {.inside = Vec3{300, 200, 400}});
    EXPECT_EQ(sides.viewpoint, Viewpoint::inside);
    EXPECT_LT(norm(sides.eye - Vec3{300, 200, 400}), 1e-9);
    EXPECT_EQ(sides.facing_away, 1u);
    EXPECT_EQ(sides_of(sides, "back")->facing_away, 1u);
  }
}

TEST(SceneSides, SheetsWithoutAFlagAreLeft) {
  Scene scene = room();
  turn_all(scene.parts[2].mesh);
  turn_all(scene.parts[3].mesh);
  SceneSides sides = find_sides(scene);
  ASSERT_EQ(sides.facing_away, 2u);
  ASSERT_EQ(sides.sheets[2].part, 2u);
  std::vector<std::uint8_t> flags(scene.parts[2].mesh.triangles.size(), 0);
  leave_sheets(sides, 2, flags);
  EXPECT_EQ(sides.parts[2].left_facing_away, 1u);
  EXPECT_EQ(sides.parts[2].turned_triangles, 0u);
  EXPECT_TRUE(sides.sheets[2].turn.empty());
  flags[7] = 1;
  leave_sheets(sides, 3, flags);
  EXPECT_EQ(sides.parts[3].left_facing_away, 0u);
  EXPECT_EQ(sides.parts[3].turned_triangles, 32u) << "the whole sheet";
}

TEST(SceneSides, AmbiguousSheetsBecomeDoubleSided) {
  Scene scene = room();
  scene.materials.emplace_back().name = "net";
  add_part(scene, "strip", test::moebius_strip(50, 20, 24, 2), {0});
  add_part(scene, "second_strip", test::moebius_strip(40, 10, 24, 2), {0});
  add_part(scene, "net", test::moebius_strip(30, 10, 24, 2), {1});
  add_part(scene, "bare", test::moebius_strip(30, 10, 24, 2));
  for (std::size_t p = 6; p < 10; ++p)
    for (Vec3& position : scene.parts[p].mesh.positions)
      position = position + Vec3{500, 500, 100.0 * static_cast<double>(p) - 400};
  Scene without = scene;
  const SceneSides sides = turn_sheets(scene);
  EXPECT_EQ(sides.ambiguous, 4u);
  EXPECT_EQ(sides_of(sides, "strip")->reasons, std::vector{SideReason::non_orientable});
  EXPECT_FALSE(scene.materials[0].double_sided);  // The walls' own.
  const std::uint32_t copy = scene.parts[6].materials[0];
  EXPECT_NE(copy, 0u);
  EXPECT_EQ(scene.parts[7].materials[0], copy);
  EXPECT_TRUE(scene.materials[copy].double_sided);
  EXPECT_EQ(scene.materials[copy].name, "paint");
  EXPECT_EQ(scene.parts[8].materials[0], 1u);  // Nobody else has it.
  EXPECT_TRUE(scene.materials[1].double_sided);
  ASSERT_EQ(scene.parts[9].materials.size(), 1u);
  EXPECT_TRUE(scene.materials[scene.parts[9].materials[0]].double_sided);

  turn_sheets(without, {.keep = false, .inside = {}, .add_materials = false});
  EXPECT_TRUE(without.parts[9].materials.empty());
}

TEST(SceneSides, RepairAndUnwrapTurn) {
  Scene scene = room();
  turn_all(scene.parts[0].mesh);
  RepairSceneOptions repair;
  repair.keep_copies = true;
  const RepairSceneResult repaired = repair_scene(scene, repair);
  EXPECT_EQ(repaired.sides.facing_away, 1u);
  EXPECT_EQ(first_normal(repaired.scene.parts[0]), (Vec3{0, 0, 1}));
  UnwrapOptions options;
  options.method.method = UnwrapMethod::planar;
  const UnwrapResult unwrapped = unwrap_scene(scene, options);
  EXPECT_EQ(unwrapped.sides.facing_away, 1u);
  EXPECT_EQ(first_normal(unwrapped.scene.parts[0]), (Vec3{0, 0, 1}));
  const Triangle& uv = unwrapped.scene.parts[0].mesh.uv.indices[0];
  const Values<Vec2>& values = unwrapped.scene.parts[0].mesh.uv.values;
  EXPECT_GT(cross(values[uv[1]] - values[uv[0]], values[uv[2]] - values[uv[0]]), 0);
  options.sides.keep = true;
  EXPECT_EQ(first_normal(unwrap_scene(scene, options).scene.parts[0]), (Vec3{0, 0, -1}));
}

TEST(SceneSides, WhatIsTooFarAwayToBeLookedAtStays) {
  Scene scene;
  TriangleMesh far = test::plane(1, 1, 1, 1);
  for (Vec3& p : far.positions) p.x += 1e16;
  add_part(scene, "far", far);
  const SceneSides sides = turn_sheets(scene);
  EXPECT_NE(sides.skipped, "");
  EXPECT_EQ(sides.open_components, 0u);
}

/// One rule with a grain of 40 mm for everything.
Materials grain_everywhere(const fs::path& folder) {
  GrainOptions options;
  options.size_px = 64;
  write_grey_image(folder / "grain.png", synthesize_grain(GrainKind::spheres6, options).picture, 8);
  MaterialRule rule;
  rule.name = "grain";
  rule.texture = folder / "grain.png";
  rule.size_mm[0] = rule.size_mm[1] = 40;
  rule.height.depth_mm = 0.2;
  AssignRule assign;
  assign.part = "door_panel*";
  assign.material = "grain";
  Materials rules;
  rules.materials = {{"grain", rule}};
  rules.assign = {assign};
  return rules;
}

/// The right door of the sample is the left one mirrored, with its back to the people.
TEST(SceneSides, BothDoorsOfTheCockpitFaceThePeople) {
  ReadOptions coarse;
  coarse.chord_mm = 0.5;
  const Scene scene = read_scene(fs::path(PAPILLA_DATA) / "cockpit.step", coarse);
  const SceneSides sides = find_sides(scene);
  EXPECT_EQ(sides.viewpoint, Viewpoint::room);
  EXPECT_EQ(sides.facing_away, 1u);
  EXPECT_EQ(sides.ambiguous, 0u);
  ASSERT_NE(sides_of(sides, "door_panel_right"), nullptr);
  EXPECT_EQ(sides_of(sides, "door_panel_right")->facing_away, 1u);
  EXPECT_EQ(sides_of(sides, "door_panel_left")->facing_away, 0u);
  const SceneSides driver = find_sides(scene, {.inside = Vec3{-370, -150, 950}});
  EXPECT_EQ(driver.facing_away, 1u);
  EXPECT_EQ(sides_of(driver, "door_panel_right")->facing_away, 1u);

  const test::TemporaryFolder folder;
  const BakeResult baked = bake_scene(scene, grain_everywhere(folder.path()));
  EXPECT_EQ(find_sides(baked.scene).facing_away, 0u);
  for (const auto& [name, inwards] : {std::pair{"door_panel_left", 1.0}, {"door_panel_right", -1.0}}) {
    const TriangleMesh& mesh = part_named(baked.scene, name).mesh;
    ASSERT_FALSE(mesh.triangles.empty());
    double area = 0, towards = 0, uv_area = 0, normals = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vec3 n = cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0));
      area += norm(n);
      towards += inwards * n.x;
      if (mesh.normals.has_value(t)) normals += dot(n, mesh.normals.values[mesh.normals.indices[t][0]]);
      const Triangle& corners = mesh.uv.indices.at(t);
      const Values<Vec2>& uv = mesh.uv.values;
      uv_area += cross(uv[corners[1]] - uv[corners[0]], uv[corners[2]] - uv[corners[0]]);
    }
    EXPECT_GT(towards, 0.9 * area) << name;  // To the middle of the car.
    EXPECT_GT(normals, 0.9 * area) << name;  // Shading and the relief's outward direction follow.
    EXPECT_GT(uv_area, 0) << name;           // The picture is not mirrored.
  }
}

/// A flat sheet in two halves, whose uv meet at an angle along the middle.
TEST(SceneSides, AChevronOfKeptUvIsReported) {
  const test::TemporaryFolder folder;
  const Materials rules = grain_everywhere(folder.path());
  const auto bake = [&](double degrees) {
    Scene scene;
    Part part;
    part.name = "door_panel";
    TriangleMesh mesh = test::plane(200, 100, 2, 1);
    const double c = std::cos(degrees * 3.14159265358979 / 180), s = std::sin(degrees * 3.14159265358979 / 180);
    mesh.uv = {};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto first = static_cast<Index>(mesh.uv.values.size());
      const bool right = mesh.corner(t, 0).x + mesh.corner(t, 1).x + mesh.corner(t, 2).x > 300;
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = mesh.corner(t, k);
        mesh.uv.values.push_back(right ? Vec2{(c * p.x - s * p.y) / 100, (s * p.x + c * p.y) / 100}
                                       : Vec2{p.x / 100, p.y / 100});
      }
      mesh.uv.indices.push_back({first, first + 1, first + 2});
    }
    add_part(scene, "door_panel", mesh);
    return bake_scene(std::move(scene), rules);
  };
  const BakeResult chevron = bake(40), straight = bake(0);
  ASSERT_EQ(chevron.surfaces.size(), 1u);
  EXPECT_EQ(chevron.surfaces[0].method, "kept");
  EXPECT_NEAR(chevron.surfaces[0].seams.turned_mm, 100, 1e-6);
  EXPECT_NEAR(chevron.surfaces[0].seams.mean_turn_deg, 40, 1e-6);
  ASSERT_EQ(chevron.scene.warnings.size(), 1u);
  EXPECT_NE(chevron.scene.warnings[0].find("'door_panel': the grain jumps in direction"), std::string::npos);
  EXPECT_EQ(straight.surfaces[0].seams.seam_mm, 0);
  EXPECT_TRUE(straight.scene.warnings.empty());
}

}  // namespace
}  // namespace papilla
