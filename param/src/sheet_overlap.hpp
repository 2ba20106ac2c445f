// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// A directed border edge of a sheet in the plane; the sheet lies on its left.
struct BorderEdge {
  Index from = 0, to = 0;  ///< Names of the end points within the sheet; equal names are equal points.
  Vec2 a, b;
};

/// A sheet in the plane whose triangles are all counter-clockwise or without area.
struct PlaneSheet {
  std::vector<std::array<Vec2, 3>> triangles;
  std::vector<std::array<Index, 3>> across;  ///< Neighbours inside the sheet, or k_no_triangle.
};

/// Whether the boxes of two edges are further apart than `tolerance`: then the edges don't conflict.
inline bool edges_apart(const BorderEdge& e, const BorderEdge& f, double tolerance) {
  const auto apart = [tolerance](double a, double b, double c, double d) {
    return std::min(a, b) > std::max(c, d) + tolerance || std::min(c, d) > std::max(a, b) + tolerance;
  };
  return apart(e.a.x, e.b.x, f.a.x, f.b.x) || apart(e.a.y, e.b.y, f.a.y, f.b.y);
}

/// Whether two border edges meet elsewhere than in a named common end point. Contact up to `tolerance` (a length)
/// counts.
bool edges_conflict(const BorderEdge& e, const BorderEdge& f, double tolerance);

/// Whether the interiors of two counter-clockwise triangles meet by more than `tolerance` (a length).
bool interiors_meet(const std::array<Vec2, 3>& a, const std::array<Vec2, 3>& b, double tolerance);

/// A sufficient condition for a sheet to be free of overlap that looks at its border alone: no edges of the border meet
/// elsewhere than in their end points, no point is visited twice, and there is one counter-clockwise loop.
/// Since no triangle is flipped, a point's number of triangles is the winding number of the border around it.
bool border_proves_injective(const std::vector<BorderEdge>& border);

/// The places in the list of edges that conflict, the lower one first: all pairs, ascending, each once.
std::vector<std::array<Index, 2>> edges_that_meet(const std::vector<BorderEdge>& border);

/// Whether some point of the plane lies inside two triangles of the sheet, up to 1e-13 of the sheet's extent.
/// Wherever two triangles overlap, the overlap region is bounded by images of the border, whose own triangle is one of
/// the overlapping ones: border triangles are tested against all, not all against all.
bool overlaps_itself(const PlaneSheet& sheet);

/// Splits a sheet into connected pieces that don't overlap themselves, each grown breadth first from the first triangle
/// that is left. @return the piece of each triangle, counted from 0.
std::vector<std::uint32_t> split_overlaps(const PlaneSheet& sheet);

}  // namespace papilla::param_detail
