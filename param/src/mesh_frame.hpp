// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"
#include "papilla/param/grain_frame.hpp"

namespace papilla::param_detail {

/// Right, back and up seen by a viewer in front of the object: a right-handed frame.
struct UprightFrame {
  Vec3 right, back, up;
};
UprightFrame upright_frame(UpAxis up);

/// Area-weighted normals of the vertices; zero where triangles cancel out.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh);

/// The direction d of length 1 with the greatest d·M d, for a symmetric positive semidefinite M given by its rows.
/// z when no direction is better than it. Power iteration: directions that are as good as each other are not told
/// apart.
Vec3 principal_axis(const std::array<Vec3, 3>& rows);

}  // namespace papilla::param_detail
