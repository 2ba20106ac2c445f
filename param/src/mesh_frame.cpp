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

Vec3 principal_axis(const std::array<Vec3, 3>& rows) {
  constexpr int k_power_steps = 200;
  const auto times = [&](Vec3 d) { return Vec3{dot(rows[0], d), dot(rows[1], d), dot(rows[2], d)}; };
  Vec3 best{0, 0, 1};
  // From every axis, so that none is orthogonal to the answer.
  for (const Vec3 start : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    Vec3 d = start;
    for (int i = 0; i < k_power_steps; ++i)
      if (const Vec3 next = normalized(times(d)); norm(next) > 0) d = next;
    if (dot(d, times(d)) > (1 + 1e-9) * dot(best, times(best))) best = d;
  }
  return best;
}

}  // namespace papilla::param_detail
