// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "io/scene_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/vertex_normals.hpp"

namespace papilla {
namespace {

using test::TemporaryFolder;

bool names(const std::vector<std::string>& losses, const std::string& what) {
  return std::any_of(losses.begin(), losses.end(),
                     [&](const std::string& l) { return l.find(what) != std::string::npos; });
}

TEST(PlyWriter, KeepsTheSurfaceAndItsSeams) {
  const TemporaryFolder folder;
  const Scene scene = test::rich_scene();
  const auto losses = write_ply(scene, folder / "a.ply");
  const Scene again = read_ply(folder / "a.ply");
  ASSERT_EQ(again.parts.size(), 1U);
  const TriangleMesh& mesh = again.parts[0].mesh;
  EXPECT_EQ(mesh.positions.size(), 16U) << "positions stay shared over seams";
  EXPECT_NEAR(test::signed_volume_times_6(again), 6 * (40. * 40 * 40 + 20. * 20 * 20), 1) << "mirrored, too";
  ASSERT_EQ(mesh.uv.indices.size(), 24U);
  const TriangleMesh& source = scene.parts[0].mesh;
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(mesh.uv.values[mesh.uv.indices[5][k]], source.uv.values[source.uv.indices[5][k]]);
  EXPECT_TRUE(again.losses.empty() && again.warnings.empty());
  EXPECT_TRUE(names(losses, "materials") && names(losses, "parts become one") && names(losses, "extras"));
  EXPECT_FALSE(names(losses, "texture coordinates"));
}

TEST(PlyWriter, AttributesOfVerticesComeBack) {
  Part part;
  part.mesh = test::cube(2);
  part.mesh.uv = {};
  part.mesh.normals = vertex_normals(part.mesh, 91);
  part.mesh.colors.values = {{1, 0, 0, 1}, {0, 0, 1, 0.5F}};
  for (const Triangle& t : part.mesh.triangles) part.mesh.colors.indices.push_back({t[0] / 4, t[1] / 4, t[2] / 4});
  const TemporaryFolder folder;
  const auto losses = write_ply(single_part_scene(part, "test"), folder / "a.ply");
  const TriangleMesh mesh = read_ply(folder / "a.ply").parts.at(0).mesh;
  EXPECT_TRUE(losses.empty()) << losses.front();
  for (std::size_t t = 0; t < 12; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(norm(mesh.normals.values[mesh.normals.indices[t][k]] -
                       part.mesh.normals.values[part.mesh.normals.indices[t][k]]),
                  0, 1e-6);
      const Color c = mesh.colors.values[mesh.colors.indices[t][k]];
      EXPECT_EQ(c.r, part.mesh.triangles[t][k] < 4 ? 1 : 0);
      EXPECT_NEAR(c.a, part.mesh.triangles[t][k] < 4 ? 1 : 0.5, 0.002);
    }
}

TEST(PlyWriter, NormalsThatJumpAreALoss) {
  Part part;
  part.mesh = test::cube(2);
  part.mesh.normals = vertex_normals(part.mesh, 40);
  const TemporaryFolder folder;
  EXPECT_TRUE(names(write_ply(single_part_scene(part, "test"), folder / "a.ply"), "normals"));
}

TEST(PlyWriter, RefusesWhatIsNoFloatAndKeepsTheOldFile) {
  const TemporaryFolder folder;
  folder.write("a.ply", "old");
  Part part;
  part.mesh = test::cube(1e300);
  EXPECT_THROW(write_ply(single_part_scene(part, "test"), folder / "a.ply"), InvalidInput);
  EXPECT_EQ(test::content_of(folder / "a.ply"), "old");
}

}  // namespace
}  // namespace papilla
