// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "io/scene_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/io/scene_file.hpp"

namespace papilla {
namespace {

using test::TemporaryFolder;

/// A cube whose sides have parameters of their own, as CAD faces do; the last side has none.
Part cube_of_faces() {
  Part part;
  part.name = "cube";
  part.mesh = test::cube(2);
  for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
    const auto side = static_cast<double>(t / 2);
    Triangle corners{k_no_value, k_no_value, k_no_value};
    if (side < 5)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 uv = part.mesh.uv.values[part.mesh.uv.indices[t][k]];
        corners[k] = static_cast<Index>(part.mesh.cad_uv.values.size());
        part.mesh.cad_uv.values.push_back({64 * uv.x - 100 * side, 3 + 8 * uv.y});
      }
    part.mesh.cad_uv.indices.push_back(corners);
  }
  return part;
}

/// Metres of 32 bits are not exactly what millimetres were.
Vec3 rounded(const Vec3& p) { return {std::round(p.x), std::round(p.y), std::round(p.z)}; }

/// Corners of a triangle in an order that does not depend on how a file numbers them; its millimetres are whole.
std::vector<std::pair<Vec3, Vec2>> sorted_corners(const TriangleMesh& mesh, std::size_t t) {
  std::vector<std::pair<Vec3, Vec2>> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners.emplace_back(rounded(mesh.corner(t, static_cast<int>(k))), mesh.cad_uv.values[mesh.cad_uv.indices[t][k]]);
  std::sort(corners.begin(), corners.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.first.x, a.first.y, a.first.z) < std::tuple(b.first.x, b.first.y, b.first.z);
  });
  return corners;
}

class CadParameters : public testing::TestWithParam<const char*> {};

TEST_P(CadParameters, ComeBackFaceByFace) {
  const TemporaryFolder folder;
  const Part part = cube_of_faces();
  const std::string file = (folder / "cube").string() + GetParam();
  const std::vector<std::string> losses = write_scene(single_part_scene(part, "test"), file);
  EXPECT_TRUE(std::none_of(losses.begin(), losses.end(), [](const auto& l) { return l.find("CAD (u,v)") == 0; }));
  const Scene again = read_scene(file);
  ASSERT_EQ(again.parts.size(), 1U);
  const TriangleMesh& mesh = again.parts[0].mesh;
  ASSERT_EQ(mesh.triangles.size(), 12U);
  ASSERT_EQ(mesh.cad_uv.indices.size(), 12U);
  for (std::size_t t = 0; t < 12; ++t) {
    EXPECT_EQ(mesh.cad_uv.has_value(t), t < 10) << t;
    if (t < 10 && mesh.cad_uv.has_value(t)) {
      EXPECT_EQ(sorted_corners(mesh, t), sorted_corners(part.mesh, t)) << t;
    }
  }
  EXPECT_TRUE(std::none_of(again.losses.begin(), again.losses.end(),
                           [](const auto& l) { return l.find("CAD") != std::string::npos; }));
}

INSTANTIATE_TEST_SUITE_P(Formats, CadParameters, testing::Values(".glb", ".gltf", ".ply"),
                         [](const auto& info) { return std::string(info.param).substr(1); });

TEST(CadParametersOfFiles, OfMeshesWithoutCadAreNotWritten) {
  const TemporaryFolder folder;
  Part part = cube_of_faces();
  part.mesh.cad_uv = {};
  for (const char* name : {"cube.glb", "cube.ply"}) {
    write_scene(single_part_scene(part, "test"), folder / name);
    EXPECT_TRUE(read_scene(folder / name).parts.at(0).mesh.cad_uv.empty()) << name;
  }
}

TEST(CadParametersOfFiles, AreALossOfObj) {
  const TemporaryFolder folder;
  const auto losses = write_scene(single_part_scene(cube_of_faces(), "test"), folder / "cube.obj");
  EXPECT_TRUE(std::any_of(losses.begin(), losses.end(),
                          [](const auto& l) { return l.find("CAD (u,v)") != std::string::npos; }));
}

}  // namespace
}  // namespace papilla
