// SPDX-License-Identifier: MIT
// What repair() promises of a mesh holds for the file it is written to, in single precision.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "io/temporary_folder.hpp"
#include "meshing/clean_mesh.hpp"
#include "meshing/shapes.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/statistics.hpp"

namespace papilla {
namespace {

using namespace test;

/// A closed surface whose rows of vertices lie ever closer, from 1 mm down to far below single precision.
TriangleMesh crowded_sphere() {
  TriangleMesh mesh = sphere(24);
  for (Vec3& p : mesh.positions) {
    p.x = std::copysign(std::pow(std::abs(p.x), 14), p.x);
    p.y = std::copysign(std::pow(std::abs(p.y), 5), p.y);
  }
  return mesh;
}

Scene scene_of(const TriangleMesh& mesh) {
  Scene scene;
  scene.up = UpAxis::y;
  Part part;
  part.name = "part";
  part.mesh = mesh;
  scene.parts.push_back(std::move(part));
  Node node;
  node.part = 0;
  scene.nodes.push_back(std::move(node));
  scene.roots.push_back(0);
  return scene;
}

/// File ending and distance of the part from the origin of its frame [mm]; the part is 2 mm wide.
class RepairedFile : public testing::TestWithParam<std::tuple<const char*, double>> {};

TEST_P(RepairedFile, IsAsCleanAsTheMesh) {
  const auto& [ending, away] = GetParam();
  const test::TemporaryFolder folder;
  for (const TriangleMesh& start : {crowded_sphere(), lattice_soup(150, 3), lattice_soup(400, 8), terrain(20, 1e-6, 2),
                                    joined(crowded_sphere(), moved(crowded_sphere(), {1e-5, 2e-6, 0}))}) {
    const TriangleMesh mesh = moved(start, {away, 0.4 * away, -0.1 * away});
    const RepairResult repaired = repair(mesh);
    EXPECT_TRUE(repaired.settled);
    test::expect_clean(repaired.mesh);
    const RepairResult again = repair(repaired.mesh);
    EXPECT_EQ(again.mesh.positions, repaired.mesh.positions);
    EXPECT_EQ(again.mesh.triangles, repaired.mesh.triangles);

    const auto file = folder / ("part" + std::string(ending));
    write_scene(scene_of(repaired.mesh), file);
    const Scene read = read_scene(file);
    ASSERT_EQ(read.parts.size(), 1u);
    const TriangleMesh& stored = read.parts[0].mesh;
    EXPECT_EQ(stored.triangles.size(), repaired.mesh.triangles.size());
    test::expect_clean(stored);
    for (std::size_t t = 0; t < stored.triangles.size(); ++t)
      EXPECT_GT(norm(cross(stored.corner(t, 1) - stored.corner(t, 0), stored.corner(t, 2) - stored.corner(t, 0))), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, RepairedFile,
                         testing::Combine(testing::Values(".glb", ".ply", ".stl"),
                                          testing::Values(0.0, 3.0, 50.0, 4000.0)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param) + 1) + "_" +
                                  std::to_string(static_cast<int>(std::get<1>(info.param)));
                         });

}  // namespace
}  // namespace papilla
