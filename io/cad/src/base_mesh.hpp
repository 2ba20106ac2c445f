// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "edge_net.hpp"

namespace papilla::cad {

/// A face's first triangles and how they came about.
struct BaseFace {
  FaceMesh mesh;
  std::string refused;             ///< Why the mesher's own triangles can't be used; empty when they can.
  std::vector<std::string> tried;  ///< What was done about it, in order.
  bool solved = true;              ///< There are triangles in the end, up to the whole boundary.
};

/// Takes the triangles that the mesher left on the shape's faces, in the order of their numbers, and the polylines of
/// their edges. Faces that it refused or left with gaps are triangulated between the same polylines, as they are or
/// healed, so that they join their neighbours.
std::vector<BaseFace> base_faces(const TopoDS_Shape& shape, EdgeNet& net, const RefineLimits& limits);

/// Number of triangles in (u, v) whose corners run clockwise.
std::size_t count_folded(const FacePatch& patch);

}  // namespace papilla::cad
