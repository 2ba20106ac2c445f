// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/Error_code.h>

#include <exception>

#include "lscm_solvers.hpp"

namespace papilla::param_detail {

using CgalKernel = CGAL::Simple_cartesian<double>;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

/// The chart with the same vertex numbers; empty when CGAL refuses a face.
CgalMesh to_cgal(const ChartSurface& chart);

/// Runs one of CGAL's parameterizers on a chart.
template <class Parameterizer>
ConformalMap parameterize_with_cgal(const ChartSurface& chart, Parameterizer parameterizer) {
  using Vertex = CgalMesh::Vertex_index;
  namespace smp = CGAL::Surface_mesh_parameterization;
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
    ConformalMap map;
    map.uv.reserve(chart.positions.size());
    for (const Vertex v : mesh.vertices()) map.uv.push_back({uv[v].x(), uv[v].y()});
    return map;
  } catch (const std::exception& error) {  // CGAL's checks throw logic errors
    const std::string what = error.what();
    return {{}, "CGAL: " + what.substr(0, what.find('\n'))};
  }
}

}  // namespace papilla::param_detail
