// SPDX-License-Identifier: MIT
#include "papilla/pipeline/shared_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace papilla {
namespace {

/// Three corners of a box that no motion but the identity takes onto themselves.
TriangleMesh bracket() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {40, 0, 0}, {0, 20, 0}, {0, 0, 10}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

Transform turned(double degrees, Vec3 by) {
  const double a = degrees * std::acos(-1.0) / 180, c = std::cos(a), s = std::sin(a);
  return {c, -s, 0, by.x, s, c, 0, by.y, 0, 0, 1, by.z, 0, 0, 0, 1};
}

TriangleMesh moved(TriangleMesh mesh, const Transform& by) {
  for (Vec3& p : mesh.positions) p = transform_point(by, p);
  return mesh;
}

Scene scene_of(const std::vector<std::pair<std::string, TriangleMesh>>& parts) {
  Scene scene;
  for (const auto& [name, mesh] : parts) {
    Part part;
    part.name = name;
    part.mesh = mesh;
    Node node;
    node.name = name;
    node.part = static_cast<std::uint32_t>(scene.parts.size());
    scene.roots.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
    scene.nodes.push_back(node);
    scene.parts.push_back(part);
  }
  return scene;
}

/// Every corner of every instance in the scene's frame, in order.
std::vector<Vec3> corners_of(const Scene& scene) {
  std::vector<Vec3> corners;
  for (const Instance& use : instances(scene))
    for (const Triangle& t : scene.parts[use.part].mesh.triangles)
      for (const Index v : t) corners.push_back(transform_point(use.world, scene.parts[use.part].mesh.positions[v]));
  return corners;
}

void expect_same_place(const Scene& before, const Scene& after) {
  const std::vector<Vec3> a = corners_of(before), b = corners_of(after);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(norm(a[i] - b[i]), 0, 1e-9) << i;
}

TEST(SharedParts, CopiesBecomeInstancesInTheirPlace) {
  const Scene before = scene_of({{"left", bracket()},
                                 {"box", moved(bracket(), {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1})},
                                 {"right", moved(bracket(), turned(37, {300, -20, 5}))}});
  Scene after = before;
  const std::vector<SharedPart> shared = share_identical_parts(after);
  ASSERT_EQ(shared.size(), 1U);
  EXPECT_EQ(shared[0].name, "right");
  EXPECT_EQ(shared[0].original, 0U);
  EXPECT_LT(shared[0].max_distance_mm, 1e-9);
  EXPECT_EQ(after.parts.size(), 2U);
  EXPECT_EQ(after.nodes.size(), 3U) << "the node of its name is enough";
  expect_same_place(before, after);
}

TEST(SharedParts, OtherMaterialsExtrasOrLabelsStayApart) {
  const Scene before = scene_of({{"a", bracket()}, {"b", bracket()}, {"c", bracket()}});
  Scene materials = before, extras = before, labels = before;
  materials.parts[1].materials = {1};
  EXPECT_EQ(share_identical_parts(materials).size(), 1U);
  extras.parts[2].extras_json = "{}";
  EXPECT_EQ(share_identical_parts(extras).size(), 1U);
  EXPECT_TRUE(share_identical_parts(labels, [](std::uint32_t part) { return part; }).empty());
}

TEST(SharedParts, NamesOfCopiesStayInTheTree) {
  Scene scene = scene_of({{"screw", bracket()}, {"bolt", moved(bracket(), turned(90, {0, 0, 50}))}});
  scene.nodes[1].name = "occurrence 7";
  const Scene before = scene;
  share_identical_parts(scene);
  ASSERT_EQ(scene.nodes.size(), 3U);
  EXPECT_EQ(scene.nodes[1].name, "occurrence 7");
  EXPECT_EQ(scene.nodes[2].name, "bolt");
  expect_same_place(before, scene);
}

TEST(SharedParts, WithoutANameThePathIsListed) {
  Scene scene = scene_of({{"a", bracket()}, {"", moved(bracket(), turned(0, {100, 0, 0}))}});
  assign_part_ids(scene);
  const std::vector<SharedPart> shared = share_identical_parts(scene);
  ASSERT_EQ(shared.size(), 1U);
  EXPECT_EQ(shared[0].name, shared[0].id);
  EXPECT_NE(shared[0].name, "");
}

TEST(SharedParts, UnevenScaleGetsAChildInsteadOfShear) {
  Scene scene = scene_of({{"a", bracket()}, {"b", moved(bracket(), turned(30, {7, 8, 9}))}});
  scene.nodes[1].local = {1, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const Scene before = scene;
  share_identical_parts(scene);
  EXPECT_EQ(scene.nodes.size(), 3U);
  EXPECT_EQ(scene.nodes[1].local, before.nodes[1].local);
  expect_same_place(before, scene);
}

TEST(SharedParts, NodesWithChildrenKeepThemInPlace) {
  Scene scene = scene_of({{"a", bracket()}, {"b", moved(bracket(), turned(30, {7, 8, 9}))}, {"a", bracket()}});
  scene.roots = {0, 1};
  scene.nodes[1].children = {2};
  const Scene before = scene;
  EXPECT_EQ(share_identical_parts(scene).size(), 2U);
  const auto sorted = [](std::vector<Vec3> v) {
    std::sort(v.begin(), v.end(), [](const Vec3& a, const Vec3& b) {
      const auto key = [](const Vec3& p) {
        return std::llround(1e3 * p.x) * 1000003 + std::llround(1e3 * p.y) * 1009 + std::llround(1e3 * p.z);
      };
      return key(a) < key(b);
    });
    return v;
  };
  const std::vector<Vec3> a = sorted(corners_of(before)), b = sorted(corners_of(scene));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(norm(a[i] - b[i]), 0, 1e-9) << i;
}

}  // namespace
}  // namespace papilla
