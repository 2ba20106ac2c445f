// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>

#include "cgal_chart.hpp"

namespace papilla::param_detail {

ConformalMap solve_lscm_cgal(const ChartSurface& chart) {
  return parameterize_with_cgal(chart, CGAL::Surface_mesh_parameterization::LSCM_parameterizer_3<CgalMesh>());
}

}  // namespace papilla::param_detail
