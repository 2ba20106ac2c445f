// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Unit normals for shading. At each vertex the triangles are grouped over the edges that exactly two triangles
/// share, in opposite directions, with an angle between their normals of at most `crease_deg`; a group's
/// normal is the sum of its triangles' area vectors, normalized: n = Σ ½ (b − a) × (c − a). Corners of triangles
/// without area that no group reaches get (0, 0, 1). Values follow the order of
/// the positions. Cost: linear, n log n at a vertex of n triangles. Deterministic.
/// @pre finite positions, indices in range.
CornerAttribute<Vec3> vertex_normals(const TriangleMesh& mesh, double crease_deg = 40);

}  // namespace papilla
