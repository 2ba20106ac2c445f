// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// The number of independent cycles of a mesh's boundary modulo 2,
///
///     E - V + C
///
/// over the edges that an odd number of triangles have, their vertices, and the C sets that these edges connect. An
/// edge of three sheets counts: two of them can go on into each other, the third ends there. On a manifold mesh whose
/// vertices have one fan each this is the number of its boundary loops.
///
/// What it is for: loops of edges of one triangle can not be compared before and after non-manifold edges are parted,
/// because a sheet that ends at two others has a border there that no edge of one triangle shows. Modulo 2 the boundary
/// is the same before and after: parting pairs the triangles of an edge and leaves one over when their number is odd.
/// The loops afterwards share no edge, so they are independent cycles of the same boundary, and no more than this. Two
/// things do add loops: surfaces without an orientation, which are cut, and edges of an even number of triangles whose
/// senses do not pair.
/// Vertices are equal by index: weld, and drop double sheets (weld_equal(), remove_duplicates()), where positions
/// count. Triangles that repeat a corner are left out. O(n); deterministic.
/// @throws InvalidInput when an index is out of range or a referenced position is not finite.
std::size_t boundary_cycles(const TriangleMesh& mesh);

}  // namespace papilla
