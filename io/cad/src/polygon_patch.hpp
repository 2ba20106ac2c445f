// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "edge_net.hpp"

namespace papilla::cad {

/// Triangulates a face between the polylines of its edges: loops in its parameters, holes joined to the outer loop,
/// ears clipped. Every segment of the boundary is used, also where the loops cross themselves by the CAD file's
/// tolerance. Cost: quadratic in the number of boundary points.
/// @param face forward.
/// @return the face with triangles and uses, or nothing when its wires are not closed in the parameters.
std::optional<FaceMesh> polygon_patch(const TopoDS_Face& face, const EdgeNet& net);

}  // namespace papilla::cad
