// SPDX-License-Identifier: MIT
#include "papilla/pipeline/repair_scene.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "papilla/core/error.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/deviation.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "papilla/meshing/orient.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

struct Folder {
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  fs::path path = fs::temp_directory_path() / ("papilla-repair-" + std::to_string(::getpid()));
};

TriangleMesh sheet() {
  TriangleMesh mesh = test::plane(100, 100, 4, 4);
  mesh.uv = {};
  return mesh;
}

TriangleMesh double_sheet() {
  TriangleMesh back = sheet(), mesh = sheet();
  turn_triangles(back, std::vector<std::uint8_t>(back.triangles.size(), 1));
  append_mesh(mesh, back);
  return mesh;
}

/// A part a mesh, all of one material.
Scene scene_of(const std::vector<TriangleMesh>& meshes) {
  Scene scene;
  scene.format = "STEP";
  scene.materials.emplace_back().name = "paint";
  for (const TriangleMesh& mesh : meshes) {
    Part part;
    part.name = "part" + std::to_string(scene.parts.size());
    part.mesh = mesh;
    part.materials = {0};
    Node node;
    node.part = static_cast<std::uint32_t>(scene.parts.size());
    scene.roots.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
    scene.nodes.push_back(node);
    scene.parts.push_back(std::move(part));
  }
  return scene;
}

const Material& material_of(const Scene& scene, std::size_t part) {
  return scene.materials[scene.parts[part].materials.at(0)];
}

TEST(RepairScene, ShowsDoubleSheetsFromBothSidesAndLeavesOthersAlone) {
  RepairSceneOptions options;
  options.sides.keep = true;
  const RepairSceneResult result = repair_scene(scene_of({double_sheet(), sheet()}), options);
  EXPECT_EQ(result.total.counts.opposites, 32U);
  EXPECT_TRUE(material_of(result.scene, 0).double_sided);
  EXPECT_FALSE(material_of(result.scene, 1).double_sided);
  EXPECT_EQ(material_of(result.scene, 1).name, "paint");
}

TEST(RepairScene, GivesDoubleSheetsWithoutMaterialOne) {
  Scene scene = scene_of({double_sheet()});
  scene.parts[0].materials.clear();
  RepairSceneOptions options;
  options.sides.keep = true;
  EXPECT_TRUE(material_of(repair_scene(scene, options).scene, 0).double_sided);
}

/// Files of data/exchange and of the folder named by PAPILLA_SHARED_DATA.
std::vector<fs::path> held_files() {
  std::vector<fs::path> files;
  const auto add = [&](const fs::path& folder) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      for (const char* known : {".stl", ".STL", ".obj", ".ply", ".off", ".glb"})
        if (extension == known) files.push_back(entry.path());
    }
  };
  add(fs::path(PAPILLA_DATA) / "exchange");
  if (const char* shared = std::getenv("PAPILLA_SHARED_DATA"))
    for (const char* folder : {"mesh", "gltf", "param"}) add(fs::path(shared) / folder);
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<bool> double_sided(const Scene& scene) {
  std::vector<bool> flags;
  for (const Material& material : scene.materials) flags.push_back(material.double_sided);
  return flags;
}

/// Nothing moves farther than is said, and repairing what was written changes nothing of it.
TEST(RepairScene, HoldsForEveryFile) {
  const Folder folder;
  const fs::path once = folder.path / "once.glb", twice = folder.path / "twice.glb";
  for (const fs::path& file : held_files()) {
    SCOPED_TRACE(file.string());
    const Scene scene = read_scene(file);
    RepairSceneOptions options;
    options.keep_copies = true;
    const RepairSceneResult result = repair_scene(scene, options);
    EXPECT_EQ(result.total.refused_triangles, 0U);
    EXPECT_TRUE(result.total.settled);
    write_scene(result.scene, once);
    const Scene first = read_scene(once);
    write_scene(repair_scene(first, options).scene, twice);
    const Scene second = read_scene(twice);
    EXPECT_EQ(double_sided(first), double_sided(second));
    ASSERT_EQ(first.parts.size(), second.parts.size());
    for (std::size_t p = 0; p < first.parts.size(); ++p) {
      EXPECT_EQ(first.parts[p].mesh.positions, second.parts[p].mesh.positions) << first.parts[p].name;
      EXPECT_EQ(first.parts[p].mesh.triangles, second.parts[p].mesh.triangles) << first.parts[p].name;
      EXPECT_EQ(first.parts[p].mesh.uv.values, second.parts[p].mesh.uv.values) << first.parts[p].name;
      EXPECT_EQ(first.parts[p].mesh.material, second.parts[p].mesh.material) << first.parts[p].name;
    }
    for (std::size_t p = 0; p < scene.parts.size(); ++p) {
      const TriangleMesh& before = scene.parts[p].mesh;
      if (before.triangles.empty() || result.parts[p].sampled) continue;
      const DeviationResult measured = surface_deviation(before, result.scene.parts[p].mesh);
      const double rounding = 1e-3 * result.parts[p].tolerance_mm;
      EXPECT_LE(measured.from_to.value, result.parts[p].lost_mm + rounding) << scene.parts[p].name;
      EXPECT_LE(measured.to_from.value, result.parts[p].added_mm + rounding) << scene.parts[p].name;
    }
  }
}

}  // namespace
}  // namespace papilla
