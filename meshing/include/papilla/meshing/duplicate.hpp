// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

struct DuplicateResult {
  TriangleMesh mesh;
  std::size_t same = 0;      ///< Dropped triangles that ran like an earlier one.
  std::size_t opposite = 0;  ///< Dropped triangles that ran against an earlier one: back sides of double sheets.
  std::size_t walls = 0;     ///< Triangles dropped beside their opposite because both only parted touching solids.
};

/// Leaves one triangle for every set of three vertices: the first. Of a double sheet (each triangle there twice, in
/// both senses) one side stays, to be shown as double-sided; where such a sheet is only the wall between two solids
/// that touch — every edge of its border carries two or more other triangles — both sides go, so that the solids
/// become one closed surface.
/// Good input is welded. O(n) plus sorting around vertices. Deterministic; the order of the rest stays.
/// @throws InvalidInput when an index is out of range or a position is not finite.
DuplicateResult remove_duplicates(TriangleMesh mesh);

}  // namespace papilla
