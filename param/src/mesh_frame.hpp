// SPDX-License-Identifier: MIT
#pragma once

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

}  // namespace papilla::param_detail
