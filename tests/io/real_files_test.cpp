// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

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

/// Files that other programs wrote, with the number of triangles that other programs count in them: those of
/// data/exchange, and those of the folder named by PAPILLA_SHARED_DATA.
std::map<fs::path, std::size_t> real_files() {
  const fs::path ours = PAPILLA_EXCHANGE_FILES;
  std::map<fs::path, std::size_t> files = {{ours / "vent.glb", 4272},        {ours / "vent.gltf", 4272},
                                           {ours / "vent.obj", 976},         {ours / "slider.stl", 412},
                                           {ours / "slider_ascii.stl", 412}, {ours / "slider.ply", 412},
                                           {ours / "slider_ascii.ply", 412}};
  if (const char* shared = std::getenv("PAPILLA_SHARED_DATA"))
    for (const auto& [name, triangles] :
         std::map<const char*, std::size_t>{{"mesh/cad-stl/i3-fan-shroud.stl", 12588},
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
                                            {"gltf/no_indices_3storybuilding.glb", 72}})
      files[fs::path(shared) / name] = triangles;
  return files;
}

TEST(RealFiles, HaveTheTrianglesThatOtherProgramsCount) {
  const test::TemporaryFolder folder;
  for (const auto& [file, triangles] : real_files()) {
    const Scene scene = read_scene(file);
    EXPECT_EQ(triangles_of(scene), triangles) << file;
    write_scene(scene, folder / "a.glb");
    EXPECT_EQ(triangles_of(read_scene(folder / "a.glb")), triangles) << file;
  }
}

/// Whether the file can be read; when not, the refusal must be one line.
bool is_read(const fs::path& file) {
  try {
    triangles_of(read_scene(file));
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << file;
    return false;
  }
}

/// Every value of a real file in turn is left out, and replaced by values of other kinds and sizes.
TEST(RealFiles, GltfWithAnyValueWrongIsReadOrRefusedInOneLine) {
  const test::TemporaryFolder folder;
  fs::copy(PAPILLA_EXCHANGE_FILES, folder.path());
  const fs::path file = folder / "vent.gltf";
  const auto whole = nlohmann::json::parse(test::content_of(file));
  std::size_t refused = 0;
  const nlohmann::json values = whole.flatten();
  for (const auto& [place, value] : values.items()) {
    SCOPED_TRACE(place);
    std::vector<nlohmann::json> edits = {{{{"op", "remove"}, {"path", place}}}};
    for (const auto& wrong : nlohmann::json::parse(R"([-1, 0, 4294967297, 1e300, "wrong", null, [], {}])"))
      edits.push_back({{{"op", "replace"}, {"path", place}, {"value", wrong}}});
    for (const nlohmann::json& edit : edits) {
      folder.write("vent.gltf", whole.patch(edit).dump());
      if (!is_read(file)) ++refused;
    }
  }
  EXPECT_GT(refused, 100U);

  // The collection of invalid files in the folder named by PAPILLA_SHARED_DATA.
  const char* shared = std::getenv("PAPILLA_SHARED_DATA");
  if (shared == nullptr) return;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(shared) / "gltf-invalid"))
    if (const std::string extension = entry.path().extension().string(); extension == ".gltf" || extension == ".glb")
      is_read(entry.path());
}

}  // namespace
}  // namespace papilla
