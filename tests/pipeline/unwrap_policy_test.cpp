// SPDX-License-Identifier: MIT
// Bake and unwrap give a part the same uv, bit for bit, on real files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <span>

#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/bake_scene.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

constexpr double k_tile_mm = 25;

/// Grain of one tile on every part; the picture is a recipe, so that no file is needed.
Materials grain_everywhere() {
  MaterialRule rule;
  rule.name = "grain", rule.recipe = "fbm|octaves=2", rule.texture = "/nonexistent/" + rule.recipe;
  rule.size_mm[0] = rule.size_mm[1] = k_tile_mm, rule.height.depth_mm = 0.2;
  Materials materials;
  materials.materials = {{"grain", rule}};
  AssignRule assign;
  assign.part = "*", assign.material = "grain";
  materials.assign = {assign};
  return materials;
}

/// What was baked is measured as it is written, in repeats of the tile and single precision.
void expect_equal_as_written(std::span<const Vec2> baked, std::span<const Vec2> unwrapped, const std::string& where) {
  ASSERT_EQ(baked.size(), unwrapped.size()) << where;
  double farthest = k_tile_mm;
  for (const Vec2& uv : unwrapped) farthest = std::max({farthest, std::abs(uv.x), std::abs(uv.y)});
  for (std::size_t i = 0; i < baked.size(); ++i) {
    ASSERT_NEAR(baked[i].x, unwrapped[i].x, 1e-6 * farthest) << where;
    ASSERT_NEAR(baked[i].y, unwrapped[i].y, 1e-6 * farthest) << where;
  }
}

/// @return how many surfaces were compared.
std::size_t expect_same_uv(const fs::path& file, double chord_mm) {
  ReadOptions read;
  read.chord_mm = chord_mm;
  Scene scene = read_scene(file, read);
  for (Part& part : scene.parts) part.mesh.uv = {};  // All of them are to be mapped anew.
  const BakeResult baked = bake_scene(scene, grain_everywhere());
  const Materials rules = grain_everywhere();
  Assignment assignment = assign_materials(scene, rules);
  share_identical_parts(scene, assignment);
  UnwrapOptions options;
  options.layout = UvLayout::tile;
  options.tile_mm = {k_tile_mm, k_tile_mm};
  std::vector<UnwrapResult> unwrapped;  // Without and with repair.
  for (const bool repair : {false, true}) {
    options.repair = repair;
    unwrapped.push_back(unwrap_scene(scene, options));
  }
  std::size_t compared = 0;
  for (const PartSurface& surface : baked.plan.surfaces) {
    if (surface.triangles.size() != scene.parts[surface.part].mesh.triangles.size()) continue;
    const auto& report = *std::find_if(baked.surfaces.begin(), baked.surfaces.end(), [&](const BakedSurface& s) {
      return s.label == surface.label && s.part == surface.part;
    });
    const TriangleMesh& mesh = unwrapped[decision(surface.plan, Stage::repair).run].scene.parts[surface.part].mesh;
    EXPECT_EQ(report.mesh.triangles, mesh.triangles) << file << ": " << surface.label;
    expect_equal_as_written(report.mesh.uv.values, mesh.uv.values, file.string() + ": " + surface.label);
    EXPECT_EQ(report.mesh.uv.indices, mesh.uv.indices) << file << ": " << surface.label;
    ++compared;
  }
  return compared;
}

TEST(UnwrapPolicy, BakeMapsTheCockpitAsUnwrapDoes) {
  EXPECT_GE(expect_same_uv(fs::path(PAPILLA_DATA) / "cockpit.step", 2), 30U);
}

/// Files of other programs, and those of the folder named by PAPILLA_SHARED_DATA.
TEST(UnwrapPolicy, BakeMapsFilesOfOthersAsUnwrapDoes) {
  std::vector<fs::path> files;
  const fs::path ours = fs::path(PAPILLA_DATA) / "exchange";
  for (const char* name : {"handle.brep", "handle.step", "knobs.step"}) files.push_back(ours / name);
  if (const char* folder = std::getenv("PAPILLA_SHARED_DATA"))
    for (const auto& entry : fs::directory_iterator(fs::path(folder) / "step"))
      if (entry.is_regular_file() && entry.file_size() < 1 << 20 && entry.path().extension() == ".step")
        files.push_back(entry.path());
  std::size_t compared = 0;
  for (const fs::path& file : files) compared += expect_same_uv(file, 0.5);
  EXPECT_GE(compared, 4U);
}

}  // namespace
}  // namespace papilla
