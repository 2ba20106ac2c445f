// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/cgal_segmentation.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/mesh_segmentation.h>

namespace papilla::bench {

std::vector<std::vector<std::uint32_t>> cgal_segments(const TriangleMesh& mesh, std::span<const std::size_t> clusters) {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  Mesh surface;
  std::vector<Mesh::Vertex_index> vertices;
  for (const Vec3& p : mesh.positions) vertices.push_back(surface.add_vertex({p.x, p.y, p.z}));
  for (const Triangle& t : mesh.triangles)
    if (surface.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]) == Mesh::null_face()) return {};
  auto diameter = surface.add_property_map<Mesh::Face_index, double>("f:sdf", 0).first;
  auto segment = surface.add_property_map<Mesh::Face_index, std::size_t>("f:segment", 0).first;
  const auto [least, greatest] = CGAL::sdf_values(surface, diameter);
  if (!(greatest > least)) return {};
  std::vector<std::vector<std::uint32_t>> all;
  for (const std::size_t count : clusters) {
    CGAL::segmentation_from_sdf_values(surface, diameter, segment, count);
    std::vector<std::uint32_t>& labels = all.emplace_back();
    for (const auto f : surface.faces()) labels.push_back(static_cast<std::uint32_t>(segment[f]));
  }
  return all;
}

}  // namespace papilla::bench
