// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/scene_file.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

std::size_t triangles_of(const Scene& scene) {
  std::size_t count = 0;
  for (const Instance& instance : instances(scene)) count += scene.parts[instance.part].mesh.triangles.size();
  return count;
}

/// Runs over files of the folder named by PAPILLA_SHARED_DATA.
class RealFiles : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("PAPILLA_SHARED_DATA");
    if (folder == nullptr) GTEST_SKIP() << "PAPILLA_SHARED_DATA is not set";
    data_ = folder;
  }
  fs::path data_;
};

TEST_F(RealFiles, HaveTheTrianglesThatOtherReadersCount) {
  const std::map<std::string, std::size_t> expected = {{"mesh/cad-stl/i3-fan-shroud.stl", 12588},
                                                       {"mesh/cad-stl/i3-LCD-cover.stl", 4016},
                                                       {"mesh/defects/multibody.stl", 32},
                                                       {"mesh/defects/openscad_toomanyvertices.stl", 13},
                                                       {"mesh/defects/chair_model.obj", 12756},
                                                       {"mesh/defects/quadknot.obj", 2880},
                                                       {"mesh/defects/negative_indices.obj", 12},
                                                       {"mesh/interior/seat_leon/seat_leon.obj", 12224},
                                                       {"mesh/interior/couch/couch.obj", 22682},
                                                       {"mesh/interior/office-chair/office-chair.obj", 22830},
                                                       {"mesh/interior/fg_extra500_cockpit.obj", 22909},
                                                       {"gltf/WickerChair.glb", 18320},
                                                       {"gltf/CesiumMilkTruck.glb", 3624},
                                                       {"gltf/AnisotropyStrengthTest.glb", 97240},
                                                       {"gltf/no_indices_3storybuilding.glb", 72}};
  const test::TemporaryFolder folder;
  for (const auto& [file, triangles] : expected) {
    const Scene scene = read_scene(data_ / file);
    EXPECT_EQ(triangles_of(scene), triangles) << file;
    write_scene(scene, folder / "a.glb");
    EXPECT_EQ(triangles_of(read_scene(folder / "a.glb")), triangles) << file;
  }
}

TEST_F(RealFiles, InvalidOnesAreReadOrRefusedInOneLine) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(data_ / "gltf-invalid")) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".gltf" && extension != ".glb") continue;
    ++count;
    try {
      triangles_of(read_scene(entry.path()));
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << entry.path();
    }
  }
  EXPECT_GT(count, 100U);
}

}  // namespace
}  // namespace papilla
