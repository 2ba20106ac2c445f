// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// A mesh as wedges: a wedge is a set of corners at one place that are joined by smooth edges. Over a smooth edge two
/// triangles meet with opposite directions, equal uv, uv1, cad_uv, colours and labels, and an angle between their
/// normals below the feature angle. So borders, seams, label borders and features are where a place has several wedges
/// or an edge has one.
struct WedgeMesh {
  Values<Vec3> positions;  ///< The distinct ones that triangles name.
  std::vector<Index> position_of_wedge;
  std::vector<Index> corner_of_wedge;  ///< Any of its corners; corner k of triangle t is number 3 t + k.
  std::vector<Index> wedge_of_corner;
  Values<Vec3> normal_of_wedge;  ///< Mean of its corners' normals, weighted by area; empty without normals.
  std::vector<Index> indices;    ///< Three wedges a triangle; triangles that repeat a place are left out.
};

/// O(n) plus sorting around each vertex; deterministic. @param mesh As check_mesh() wants it.
WedgeMesh make_wedges(const TriangleMesh& mesh, double feature_angle_deg, bool keep_faces);

/// The mesh of some triangles between wedges of `source`, with all that their wedges carry. Triangles that repeat a
/// place are left out, as are values that none uses.
TriangleMesh extract(const WedgeMesh& wedges, const TriangleMesh& source, std::span<const Index> indices);

}  // namespace papilla::detail
