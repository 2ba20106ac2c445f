// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// A surface with fewer triangles, between vertices of the one that it stands for.
struct CoarseMesh {
  TriangleMesh mesh;            ///< Positions and triangles alone.
  std::vector<Index> vertices;  ///< Per vertex: which one of the finer mesh it is.
};

/// Half-edge collapses as those of simplify(), but for meshes to compute on, not to look at: edges of even length come
/// before a close fit, features are no creases, and nothing is measured. Topology stays: pieces, handles, the number of
/// borders, edges of three triangles. Borders are thinned out along their course.
///
/// Good input: welded; vertices at one place count as one. Ends above the target where nothing more can go. Serial,
/// O(n log n), 2 to 3 us a triangle. Deterministic.
/// @throws InvalidInput when positions are not finite or indices out of range.
CoarseMesh coarsen(const TriangleMesh& mesh, std::size_t target_triangles);

}  // namespace papilla
