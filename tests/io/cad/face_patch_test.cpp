// SPDX-License-Identifier: MIT
// Triangles of one face: what a flip keeps, and the parameters of nodes on collapsed edges.
#include "face_patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace papilla::cad {
namespace {

/// Nodes 0 to 3 around a square with the diagonal 0-2, and a triangle beyond each of its sides with a tip from 4 on.
FacePatch square_in_a_star() {
  FacePatch patch;
  patch.nodes.resize(8);
  patch.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 4}, {2, 1, 5}, {3, 2, 6}, {0, 3, 7}};
  EXPECT_TRUE(patch.connect());
  return patch;
}

HalfEdge half_edge(const FacePatch& patch, Index from, Index to) {
  for (HalfEdge h = 0; h < 3 * patch.triangles.size(); ++h)
    if (patch.from(h) == from && patch.to(h) == to) return h;
  return k_no_value;
}

TEST(FacePatch, AMarkedEdgeBesideAFlipStaysMarked) {
  for (const auto& [from, to] : {std::pair<Index, Index>{0, 1}, {1, 2}, {2, 3}, {3, 0}}) {
    FacePatch patch = square_in_a_star();
    patch.fix(half_edge(patch, from, to));
    patch.flip(half_edge(patch, 0, 2));
    EXPECT_EQ(half_edge(patch, 0, 2), k_no_value);
    EXPECT_NE(half_edge(patch, 1, 3), k_no_value);
    for (HalfEdge h = 0; h < 3 * patch.triangles.size(); ++h) {
      if (patch.is_boundary(h)) continue;
      const bool marked = std::minmax(patch.from(h), patch.to(h)) == std::minmax(from, to);
      EXPECT_EQ(patch.is_fixed(h), marked) << patch.from(h) << "-" << patch.to(h) << ", marked " << from << "-" << to;
    }
  }
}

TEST(FacePatch, ACollapsedParameterIsThatOfTheOtherCorners) {
  FacePatch patch;
  patch.nodes.resize(3);
  patch.nodes[0].uv = {1, 2};
  patch.nodes[1].uv = {3, 4};
  patch.nodes[2].uv = {7, 10};
  patch.triangles = {{0, 1, 2}};
  patch.nodes[0].free_u = true;
  EXPECT_EQ(patch.corner_uv(0, 0), (Vec2{5, 2}));
  patch.nodes[0].free_u = false, patch.nodes[0].free_v = true;
  EXPECT_EQ(patch.corner_uv(0, 0), (Vec2{1, 7}));
  EXPECT_EQ(patch.corner_uv(0, 1), (Vec2{3, 4}));
  EXPECT_EQ(patch.corner_uv(0, 2), (Vec2{7, 10}));
}

}  // namespace
}  // namespace papilla::cad
