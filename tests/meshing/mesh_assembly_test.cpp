// SPDX-License-Identifier: MIT
#include "papilla/meshing/mesh_assembly.hpp"

#include <gtest/gtest.h>

#include <array>

namespace papilla {
namespace {

/// Two triangles of a unit square; uv on the second one only.
TriangleMesh square() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.uv.values = {{0, 0}, {1, 1}, {0, 1}};
  mesh.uv.indices = {{k_no_value, k_no_value, k_no_value}, {0, 1, 2}};
  mesh.material = {5, 6};
  return mesh;
}

TEST(MeshAssembly, ExtractsTrianglesWithTheirAttributes) {
  const TriangleMesh piece = extract_triangles(square(), std::array{Index{1}});
  ASSERT_EQ(piece.triangles.size(), 1U);
  EXPECT_EQ(piece.positions.size(), 3U);
  EXPECT_EQ(piece.corner(0, 2), (Vec3{0, 1, 0}));
  EXPECT_EQ(piece.uv.values[piece.uv.indices[0][1]], (Vec2{1, 1}));
  EXPECT_EQ(piece.material, (Values<std::uint32_t>{6}));
  EXPECT_TRUE(piece.normals.empty());
}

TEST(MeshAssembly, AppendingThePiecesGivesTheSameTriangles) {
  const TriangleMesh whole = square();
  TriangleMesh joined = extract_triangles(whole, std::array{Index{0}});
  append_mesh(joined, extract_triangles(whole, std::array{Index{1}}));
  ASSERT_EQ(joined.triangles.size(), 2U);
  for (std::size_t t = 0; t < 2; ++t)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(joined.corner(t, k), whole.corner(t, k));
  EXPECT_FALSE(joined.uv.has_value(0));
  EXPECT_TRUE(joined.uv.has_value(1));
  EXPECT_EQ(joined.material, whole.material);
}

TEST(MeshAssembly, FillsAttributesThatOnePieceLacks) {
  TriangleMesh plain = square();
  plain.uv = {};
  plain.material.clear();
  TriangleMesh joined = plain;
  append_mesh(joined, square());
  ASSERT_EQ(joined.uv.indices.size(), 4U);
  EXPECT_FALSE(joined.uv.has_value(0));
  EXPECT_TRUE(joined.uv.has_value(3));
  EXPECT_EQ(joined.material, (Values<std::uint32_t>{0, 0, 5, 6}));
  TriangleMesh reversed = square();
  append_mesh(reversed, plain);
  ASSERT_EQ(reversed.uv.indices.size(), 4U);
  EXPECT_TRUE(reversed.uv.has_value(1));
  EXPECT_FALSE(reversed.uv.has_value(2));
}

}  // namespace
}  // namespace papilla
