// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

struct DuplicateResult {
  TriangleMesh mesh;
  std::size_t same = 0;        ///< Dropped triangles that ran like an earlier one.
  std::size_t opposite = 0;    ///< Dropped triangles that ran against an earlier one: backs of double sheets.
  std::size_t kept_walls = 0;  ///< Backs that stay because their sheet lies between two places that others bound.
  std::size_t kept_backs = 0;  ///< Backs that stay because their sheet looks different from behind.
  std::set<std::uint32_t> two_sided;  ///< Materials (TriangleMesh::material, 0 without) of sheets whose back was
                                      ///< dropped: to be shown from both sides.
};

/// Leaves one triangle for every set of three vertices that run the same way: the first. Of a double sheet (each
/// triangle there twice, in both senses) the fronts stay, which come first, to be shown from both sides. Backs stay:
/// - of walls, sheets of which every border edge carries two or more other triangles: each side goes on into the place
///   that it bounds, a solid that touches another, or a compartment;
/// - of sheets of which a triangle has another material, colour or texture coordinate behind than in front.
/// split_nonmanifold() parts them.
/// Good input is welded. O(n) plus sorting around vertices. Deterministic; the order of the rest stays.
/// @throws InvalidInput when an index is out of range or a position is not finite.
DuplicateResult remove_duplicates(TriangleMesh mesh);

}  // namespace papilla
