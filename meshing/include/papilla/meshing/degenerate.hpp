// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Options of remove_degenerate().
struct DegenerateOptions {
  double relative_altitude =
      1e-7;  ///< Triangles flatter than this fraction of the bounding diagonal are degenerate, in [0, 0.1].
};

struct DegenerateResult {
  TriangleMesh mesh;
  std::size_t found = 0;        ///< Degenerate triangles of the input, repeated corners included.
  std::size_t repeated = 0;     ///< Triangles dropped because they named a vertex twice.
  std::size_t collapsed = 0;    ///< Triangles whose shortest edge was collapsed.
  std::size_t flipped = 0;      ///< Triangles whose long edge was replaced by edges through the middle vertex.
  std::size_t pushed = 0;       ///< Apexes that were pushed off their long edge.
  std::size_t left = 0;         ///< Degenerate triangles that none of this helped.
  double max_deviation_mm = 0;  ///< The furthest that a vertex moved or that a removed cap reached beyond the edge.
};

/// Removes triangles whose smallest altitude is below the tolerance without opening the surface:
/// - a needle (its apex within four tolerances of an end of the longest edge) has its short edge collapsed;
/// - a cap (its apex inside the longest edge) goes, and every other triangle on that edge is split at the apex,
///   which for two triangles is an edge flip; attributes are interpolated along the edge.
/// - a cap whose long edge was flipped away before and came back, or after 16 k + 256 flips, sits in a quadrangle that
/// is
///   flat either way round: its apex is pushed two tolerances off the edge.
/// Longest first, until none is left. Splits only insert existing vertices, so no T-junction appears.
/// Good input is welded by index. O(n) to look, O(k log k) for k degenerate triangles with bounded vertex degree;
/// always ends, since flips and pushes are limited and every collapse takes a vertex away. Deterministic.
/// @throws InvalidInput when an index is out of range, a position is not finite or the option is out of range.
DegenerateResult remove_degenerate(TriangleMesh mesh, const DegenerateOptions& options = {});

}  // namespace papilla
