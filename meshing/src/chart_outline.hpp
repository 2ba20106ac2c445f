// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chart_field.hpp"
#include "papilla/core/vec.hpp"

namespace papilla::detail {

/// A chart by its outer border, flattened: what neighbours are fitted against.
struct ChartOutline {
  std::vector<Index> triangles;
  std::vector<Index> border;    ///< Half-edges of the surface along the outer loop, the chart on their left.
  std::vector<Vec2> place;      ///< Where each border half-edge starts in the plane.
  std::vector<double> turning;  ///< π - Σ angles of the chart there, on the surface.
  double area = 0, distortion = 0;
};

/// @param field of this piece.
ChartOutline make_outline(const Piece& piece, const ChartField& field);

}  // namespace papilla::detail
