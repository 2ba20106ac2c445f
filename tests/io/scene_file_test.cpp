// SPDX-License-Identifier: MIT
#include "papilla/io/scene_file.hpp"

#include <gtest/gtest.h>

#include "io/scene_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using test::message_of;
using test::TemporaryFolder;

TEST(SceneFile, WritesAndReadsByExtension) {
  const TemporaryFolder folder;
  const Scene scene = test::rich_scene();
  for (const char* name : {"a.GLB", "ä b.obj", "a.Stl"}) {
    write_scene(scene, folder / name);
    double last = -1;
    const Scene back = read_scene(folder / name, {}, [&](const Progress& done) {
      last = done.fraction;
      return true;
    });
    EXPECT_EQ(last, 1);
    std::size_t triangles = 0;
    for (const Instance& instance : instances(back)) triangles += back.parts[instance.part].mesh.triangles.size();
    EXPECT_EQ(triangles, 24U) << name;
  }
}

TEST(SceneFile, TheUpAxisCanBeOverridden) {
  const TemporaryFolder folder;
  write_scene(test::rich_scene(), folder / "a.glb");
  ReadOptions options;
  options.up = UpAxis::z;
  EXPECT_EQ(read_scene(folder / "a.glb", options).up, UpAxis::z);
}

TEST(SceneFile, MillimetresAreDoubtedWhereNothingIsThatSmall) {
  const TemporaryFolder folder;
  const auto warnings_of = [&](const std::string& high, std::optional<double> unit) {
    ReadOptions options;
    options.millimetres_per_unit = unit;
    return read_scene(folder.write("a.obj", "v 0 0 0\nv 4.1 0 0\nv 0 2.2 " + high + "\nf 1 2 3\n"), options).warnings;
  };
  const auto small = warnings_of("1.3", std::nullopt);
  ASSERT_EQ(small.size(), 1U);
  EXPECT_NE(small[0].find("4.1 x 2.2 x 1.3"), std::string::npos) << small[0];
  EXPECT_TRUE(warnings_of("1.3", 1).empty()) << "said so by the user";
  EXPECT_TRUE(warnings_of("1.3", 1000).empty());
  EXPECT_TRUE(warnings_of("10.3", std::nullopt).empty());
}

TEST(SceneFile, DoubtsNameTheThingWithItsArticle) {
  const TemporaryFolder folder;
  const auto warning_of = [&](const std::string& file) {
    return read_scene(folder.write(file, "v 0 0 0\nv 200 0 0\nv 0 200 100\nf 1 2 3\n")).warnings.at(0);
  };
  EXPECT_NE(warning_of("armchair.obj").find("small for an armchair"), std::string::npos) << warning_of("armchair.obj");
  EXPECT_NE(warning_of("sofa.obj").find("small for a sofa"), std::string::npos) << warning_of("sofa.obj");
}

TEST(SceneFile, GltfIsKnownByItsExtensionInAnyCase) {
  for (const char* name : {"a.glb", "a.GLB", "a.Glb", "b/a.gltf", "a.GLTF", "a.Gltf"})
    EXPECT_TRUE(is_gltf_file(name)) << name;
  for (const char* name : {"a.obj", "gltf", "a.gltf.png", ".gltf/a"}) EXPECT_FALSE(is_gltf_file(name)) << name;
}

TEST(SceneFile, UnknownExtensionsListTheKnownOnes) {
  const TemporaryFolder folder;
  const auto read = message_of<InvalidInput>([&] { read_scene(folder.write("a.foo", "x")); });
  EXPECT_NE(read.find(".obj"), std::string::npos);
  const auto write = message_of<InvalidInput>([&] { write_scene(Scene{}, folder / "b.foo"); });
  EXPECT_NE(write.find(".glb"), std::string::npos);
  EXPECT_THROW(read_scene(folder / "none.foo"), IoError);
  EXPECT_THROW(read_scene(folder / "."), IoError);
}

}  // namespace
}  // namespace papilla
