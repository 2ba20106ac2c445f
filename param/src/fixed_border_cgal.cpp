// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Surface_mesh_parameterization/Barycentric_mapping_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Circular_border_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Mean_value_coordinates_parameterizer_3.h>

#include "cgal_chart.hpp"
#include "reference_cgal.hpp"

namespace papilla::param_detail {
namespace smp = CGAL::Surface_mesh_parameterization;

using Circle = smp::Circular_border_arc_length_parameterizer_3<CgalMesh>;

ConformalMap solve_tutte_cgal(const ChartSurface& chart) {
  return parameterize_with_cgal(chart, smp::Barycentric_mapping_parameterizer_3<CgalMesh, Circle>());
}

ConformalMap solve_mean_value_cgal(const ChartSurface& chart) {
  return parameterize_with_cgal(chart, smp::Mean_value_coordinates_parameterizer_3<CgalMesh, Circle>());
}

}  // namespace papilla::param_detail
