// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// What a mesh is made of and what is wrong with it. Positions that are exactly equal count as one vertex,
/// so that a soup and its welded form give the same numbers. Tolerances are fractions of the bounding diagonal, or of
/// 0.6 of the farthest distance from the origin where that is more, below which single precision has no area.
struct MeshStatistics {
  std::size_t triangles = 0;
  std::size_t vertices = 0;  ///< Distinct positions that triangles name.
  std::size_t edges = 0;
  std::size_t components = 0;         ///< Sets of triangles connected through edges.
  std::size_t boundary_edges = 0;     ///< Edges of one triangle.
  std::size_t boundary_loops = 0;     ///< Sets of boundary edges connected through vertices.
  double genus = 0;                   ///< Sum of (2 - loops - V + E - F) / 2 over the components whose edges all have
                                      ///< at most two triangles; halves come from non-orientable or pinched ones.
  std::size_t nonmanifold_edges = 0;  ///< Edges of more than two triangles.
  std::size_t degenerate_triangles = 0;  ///< Repeated corner, or smallest altitude < 1e-7 of that length.
  std::size_t duplicate_triangles =
      0;                          ///< Triangles beyond the first with the same three vertices, whatever their sense.
  std::size_t flipped_edges = 0;  ///< Edges whose two triangles run the same way along them.
  std::size_t t_junctions = 0;    ///< Boundary vertices inside another boundary edge, within 1e-6 of it.
  double aspect_max = 0;          ///< Longest edge / smallest altitude, degenerate triangles left out.
  Vec3 low, high;                 ///< Bounding box of the vertices [mm]; zero for an empty mesh.
  double area_mm2 = 0;
  std::optional<double>
      volume_mm3;  ///< Signed, positive when oriented outward; only for closed, consistently oriented meshes.
  bool has_uv = false;
};

/// Measures a mesh as it is; the mesh need be neither welded nor manifold nor oriented.
/// Edges, components and loops are those of the triangles without repeated corners.
/// Cost: O(n) plus O(b log b) for b boundary edges. Deterministic.
/// @throws InvalidInput when an index is out of range, or a referenced position is not finite or beyond 1e100.
MeshStatistics mesh_statistics(const TriangleMesh& mesh);

}  // namespace papilla
