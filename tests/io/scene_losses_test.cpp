// SPDX-License-Identifier: MIT
#include "scene_losses.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/scene_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/io/scene_file.hpp"

namespace papilla {
namespace {

std::size_t count_naming(const std::vector<std::string>& losses, const std::string& what) {
  return static_cast<std::size_t>(std::count_if(
      losses.begin(), losses.end(), [&](const std::string& loss) { return loss.find(what) != std::string::npos; }));
}

TEST(SceneLosses, EachThingThatAFormatLacksIsNamedOnce) {
  Scene scene = test::rich_scene();
  scene.parts[0].mesh.uv1 = scene.parts[0].mesh.uv;
  scene.parts[0].mesh.cad_uv = scene.parts[0].mesh.uv;
  scene.parts[0].mesh.face.assign(12, 1);
  const auto losses = scene_losses(scene, {});
  for (const char* what :
       {"2 parts become one", "1 repeated parts", "1 nodes above", "1 parts' texture coordinates", "second texture",
        "CAD (u,v)", "face numbers", "2 materials", "1 nodes' extras", "1 parts' extras", "1 scene's extras"})
    EXPECT_EQ(count_naming(losses, what), 1U) << what;
  EXPECT_EQ(losses.size(), 11U);
}

TEST(SceneLosses, AllThatIsKeptIsNotNamed) {
  FormatKeeps all{true, true, true, true, true, true, true, true, true, true};
  EXPECT_TRUE(scene_losses(test::rich_scene(), all).empty());
  all.all_of_materials = false;
  const auto losses = scene_losses(test::rich_scene(), all);
  EXPECT_EQ(count_naming(losses, "haptic"), 1U);
  EXPECT_EQ(count_naming(losses, "materials' extensions"), 1U);
  EXPECT_EQ(losses.size(), 2U);
}

TEST(SceneLosses, EveryWriterTellsThem) {
  const test::TemporaryFolder folder;
  Scene scene = test::rich_scene();
  EXPECT_TRUE(write_scene(scene, folder / "a.glb").empty());
  scene.parts[0].mesh.face.assign(12, 1);
  EXPECT_EQ(write_scene(scene, folder / "a.glb").size(), 1U);
  for (const char* name : {"a.obj", "a.stl", "a.ply", "a.off"})
    EXPECT_GE(write_scene(scene, folder / name).size(), 3U) << name;
}

}  // namespace
}  // namespace papilla
