// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

struct SeamVisibilityOptions {
  Vec2 tile_mm{0, 0};   ///< Size of the texture's repeat; jumps are counted modulo it. 0: no repeat.
  double grain_mm = 1;  ///< Size of one grain, of the structure that the eye follows; above 0.
};

struct SeamVisibility {
  double seam_mm = 0;       ///< Length of the edges at which uv jumps.
  double visible_mm = 0;    ///< Σ over the seams of length · min(1, jump / grain size).
  double mean_jump_mm = 0;  ///< Of |jump| modulo the tile, by length.
  double max_jump_mm = 0;
  double mean_turn_deg = 0;  ///< By length: how far the grain's direction turns at the seam.
  double turned_mm = 0;      ///< Length over which it turns by more than 15 degrees though the surface is smooth there,
                             ///< its normals within 30 degrees: a chevron.
  /// visible_mm / √(area of the surface): how much seam one sees per size of the part. 0: none.
  double per_size = 0;
};

/// How much the seams of a tiled texture show. Along each edge of two triangles whose uv differ, the jump
///     j(s) = |uv on one side - uv on the other|   modulo the tile
/// is compared with the size of a grain: a jump of a tenth of a grain hides in it, one of a whole grain or more shows
/// as a line, the finer the grain the sooner. Sampled at five points of each edge. That is the known price of triple
/// projection; with it methods can be compared on one part. O(n), deterministic.
/// @param uv in millimetres, of this mesh.
/// @throws InvalidInput when the uv do not fit the mesh or are not finite, or an option is out of range.
SeamVisibility seam_visibility(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                               const SeamVisibilityOptions& options = {});

}  // namespace papilla
