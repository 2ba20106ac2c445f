// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include "papilla/meshing/statistics.hpp"

namespace papilla::test {

/// What repair() promises of every mesh.
inline void expect_clean(const TriangleMesh& mesh) {
  const MeshStatistics s = mesh_statistics(mesh);
  EXPECT_EQ(s.degenerate_triangles, 0u);
  EXPECT_EQ(s.duplicate_triangles, 0u);
  EXPECT_EQ(s.nonmanifold_edges, 0u);
  EXPECT_EQ(s.flipped_edges, 0u);
  EXPECT_EQ(s.t_junctions, 0u);
}

}  // namespace papilla::test
