// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal_chart.hpp"

namespace papilla::param_detail {

CgalMesh to_cgal(const ChartSurface& chart) {
  CgalMesh mesh;
  mesh.reserve(static_cast<CgalMesh::size_type>(chart.positions.size()),
               static_cast<CgalMesh::size_type>(chart.positions.size() + chart.triangles.size()),
               static_cast<CgalMesh::size_type>(chart.triangles.size()));
  const auto vertex = [](Index i) { return CgalMesh::Vertex_index(i); };
  for (const Vec3& p : chart.positions) mesh.add_vertex({p.x, p.y, p.z});
  for (const Triangle& t : chart.triangles)
    if (mesh.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2])) == CgalMesh::null_face()) return {};
  return mesh;
}

}  // namespace papilla::param_detail
