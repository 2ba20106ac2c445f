// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// The named triangles, in the order given, as a mesh of their own with all they carry. Positions and values are
/// numbered in the order of their first use, so that naming all triangles gives the mesh the numbers it would have in a
/// file read from front to back; what no triangle uses is left out.
/// Cost: O(k + r) for k triangles whose vertices and values have numbers in ranges of length r. Deterministic.
/// @param mesh with indices in range.
/// @param triangles numbers of triangles of the mesh.
TriangleMesh extract_triangles(const TriangleMesh& mesh, std::span<const Index> triangles);

/// Appends `piece` to `mesh`. Attributes that only one of the two has are filled with "no value" (numbers per
/// triangle: 0) for the other. Cost: O(size of the piece), and of the mesh where the piece brings a new attribute.
void append_mesh(TriangleMesh& mesh, const TriangleMesh& piece);

}  // namespace papilla
