// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/Error_code.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>

#include <exception>

#include "lscm_solvers.hpp"

namespace papilla::param_detail {
namespace {

namespace smp = CGAL::Surface_mesh_parameterization;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Mesh::Vertex_index;

Vertex vertex(Index i) { return Vertex(i); }

Mesh to_cgal(const ChartSurface& chart) {
  Mesh mesh;
  mesh.reserve(static_cast<Mesh::size_type>(chart.positions.size()),
               static_cast<Mesh::size_type>(chart.positions.size() + chart.triangles.size()),
               static_cast<Mesh::size_type>(chart.triangles.size()));
  for (const Vec3& p : chart.positions) mesh.add_vertex({p.x, p.y, p.z});
  for (const Triangle& t : chart.triangles)
    if (mesh.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2])) == Mesh::null_face()) return {};
  return mesh;
}

ConformalMap parameterize(const ChartSurface& chart) {
  Mesh mesh = to_cgal(chart);
  if (mesh.number_of_faces() != chart.triangles.size()) return {{}, "CGAL refuses the chart as not manifold"};
  const std::vector<Index> border = border_loops(chart).front();
  const auto inner = mesh.halfedge(vertex(border[0]), vertex(border[1]));
  if (inner == Mesh::null_halfedge()) return {{}, "CGAL finds no border"};
  auto uv = mesh.add_property_map<Vertex, Kernel::Point_2>("v:uv", {0, 0}).first;
  auto index = mesh.add_property_map<Vertex, int>("v:index", 0).first;
  auto fixed = mesh.add_property_map<Vertex, bool>("v:fixed", false).first;
  for (const Vertex v : mesh.vertices()) index[v] = static_cast<int>(v.idx());
  smp::LSCM_parameterizer_3<Mesh> parameterizer;
  const smp::Error_code code = parameterizer.parameterize(mesh, mesh.opposite(inner), uv, index, fixed);
  if (code != smp::OK) return {{}, std::string("CGAL: ") + smp::get_error_message(code)};
  ConformalMap map;
  map.uv.reserve(chart.positions.size());
  for (const Vertex v : mesh.vertices()) map.uv.push_back({uv[v].x(), uv[v].y()});
  return map;
}

}  // namespace

ConformalMap solve_lscm_cgal(const ChartSurface& chart) {
  try {
    return parameterize(chart);
  } catch (const std::exception& error) {  // CGAL's checks throw logic errors
    std::string what = error.what();
    return {{}, "CGAL: " + what.substr(0, what.find('\n'))};
  }
}

}  // namespace papilla::param_detail
