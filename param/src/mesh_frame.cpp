// SPDX-License-Identifier: MIT
#include "mesh_frame.hpp"

namespace papilla::param_detail {

UprightFrame upright_frame(UpAxis up) {
  if (up == UpAxis::z) return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
}

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 n = cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0));
    for (const Index v : mesh.triangles[t]) normals[v] = normals[v] + n;
  }
  for (Vec3& n : normals) n = normalized(n);
  return normals;
}

}  // namespace papilla::param_detail
