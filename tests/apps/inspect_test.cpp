// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "io/scene_fixtures.hpp"
#include "json/scene_json.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "text/scene_text.hpp"

namespace papilla::app {
namespace {

Scene tagged_scene() {
  Scene scene = test::rich_scene();
  MaterialTag tag;
  tag.stiffness = 900;
  tag.height.emplace();
  tag.height->uri = "data:image/png;base64,iVBORw==";
  tag.height->size = {640, 480};
  scene.materials[0].haptic = tag;
  scene.materials[0].extras_json.clear();
  scene.asset.copyright = "CC-BY\nsomebody";
  scene.asset.extras_json = R"({"license":"CC-BY-4.0"})";
  scene.tags = {3, {{"oak", "part"}, {"steel", ""}}};
  return scene;
}

TEST(Inspect, ListsHapticTagsAsJson) {
  const Scene scene = tagged_scene();
  const Json json = inspect_json(scene, part_statistics(scene), {}, nullptr);
  const Json& haptic = json["haptic"];
  ASSERT_EQ(haptic["tags"].size(), 1U);
  EXPECT_EQ(haptic["tags"][0]["material"], "grain");
  EXPECT_EQ(haptic["tags"][0]["triangles"], 22) << "eleven of the cube, which stands there twice";
  EXPECT_EQ(haptic["tags"][0]["tag"]["stiffness"], 900);
  EXPECT_EQ(haptic["tags"][0]["tag"]["height"]["uri"], "data:") << "without its bytes";
  EXPECT_EQ(haptic["expected"], 3);
  EXPECT_EQ(haptic["restored"], Json::parse(R"([{"material":"oak","by":"part"}])"));
  EXPECT_EQ(haptic["lost"], Json::parse(R"(["steel"])"));
  EXPECT_EQ(json["asset"]["extras"]["license"], "CC-BY-4.0");
}

TEST(Inspect, TellsAllSidesOfAPart) {
  Scene scene = test::rich_scene();
  for (Vec3& p : scene.parts[0].mesh.positions) p = {p.x, 2 * p.y, 3 * p.z};
  const Json json = inspect_json(scene, part_statistics(scene), {}, nullptr);
  EXPECT_EQ(json["parts"][0]["bbox_mm"], Json({20, 40, 60}));
  EXPECT_EQ(json["parts"][0]["instances"], 2);
}

TEST(Inspect, ListsHapticTagsAsText) {
  const Scene scene = tagged_scene(), untagged = test::rich_scene();
  const std::string text = inspect_text(scene, part_statistics(scene), {}, {});
  EXPECT_NE(text.find("1 haptic tags\n"), std::string::npos);
  EXPECT_NE(text.find("       22      900"), std::string::npos) << text;
  EXPECT_NE(text.find("640 x 480  grain\n"), std::string::npos) << text;
  EXPECT_NE(text.find("copyright: CC-BY somebody\n"), std::string::npos) << "on one line";
  EXPECT_NE(inspect_text(untagged, part_statistics(untagged), {}, {}).find("no haptic tag"), std::string::npos);
}

}  // namespace
}  // namespace papilla::app
