// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Barycentric_mapping_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Circular_border_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Error_code.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Mean_value_coordinates_parameterizer_3.h>

#include <exception>

#include "chart_solvers.hpp"

namespace papilla::param_detail {
namespace {

namespace smp = CGAL::Surface_mesh_parameterization;

using CgalKernel = CGAL::Simple_cartesian<double>;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;
using Circle = smp::Circular_border_arc_length_parameterizer_3<CgalMesh>;

/// The chart with the same vertex numbers; empty when CGAL refuses a face.
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

/// Runs one of CGAL's parameterizers on a chart.
template <class Parameterizer>
SolvedMap parameterize_with_cgal(const ChartSurface& chart, Parameterizer parameterizer) {
  using Vertex = CgalMesh::Vertex_index;
  try {
    CgalMesh mesh = to_cgal(chart);
    if (mesh.number_of_faces() != chart.triangles.size()) return {{}, "CGAL refuses the chart as not manifold"};
    const std::vector<Index> border = border_loops(chart).front();
    const auto inner = mesh.halfedge(Vertex(border[0]), Vertex(border[1]));
    if (inner == CgalMesh::null_halfedge()) return {{}, "CGAL finds no border"};
    auto uv = mesh.add_property_map<Vertex, CgalKernel::Point_2>("v:uv", {0, 0}).first;
    auto index = mesh.add_property_map<Vertex, int>("v:index", 0).first;
    auto fixed = mesh.add_property_map<Vertex, bool>("v:fixed", false).first;
    for (const Vertex v : mesh.vertices()) index[v] = static_cast<int>(v.idx());
    const smp::Error_code code = parameterizer.parameterize(mesh, mesh.opposite(inner), uv, index, fixed);
    if (code != smp::OK) return {{}, std::string("CGAL: ") + smp::get_error_message(code)};
    SolvedMap map;
    map.uv.reserve(chart.positions.size());
    for (const Vertex v : mesh.vertices()) map.uv.push_back({uv[v].x(), uv[v].y()});
    return map;
  } catch (const std::exception& error) {  // CGAL's checks throw logic errors
    const std::string what = error.what();
    return {{}, "CGAL: " + what.substr(0, what.find('\n'))};
  }
}

}  // namespace

SolvedMap solve_lscm_cgal(const ChartSurface& chart) {
  return parameterize_with_cgal(chart, smp::LSCM_parameterizer_3<CgalMesh>());
}

SolvedMap solve_tutte_cgal(const ChartSurface& chart) {
  return parameterize_with_cgal(chart, smp::Barycentric_mapping_parameterizer_3<CgalMesh, Circle>());
}

SolvedMap solve_mean_value_cgal(const ChartSurface& chart) {
  return parameterize_with_cgal(chart, smp::Mean_value_coordinates_parameterizer_3<CgalMesh, Circle>());
}

SolvedMap solve_arap_cgal(const ChartSurface& chart, const ArapSettings& settings) {
  using Parameterizer = smp::ARAP_parameterizer_3<CgalMesh>;
  return parameterize_with_cgal(
      chart, Parameterizer(Parameterizer::Border_parameterizer(), Parameterizer::Solver_traits(), settings.lambda,
                           static_cast<unsigned int>(settings.iterations), settings.tolerance));
}

}  // namespace papilla::param_detail
