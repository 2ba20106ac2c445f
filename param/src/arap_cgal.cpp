// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>

#include "cgal_chart.hpp"
#include "reference_cgal.hpp"

namespace papilla::param_detail {

ConformalMap solve_arap_cgal(const ChartSurface& chart, const ArapSettings& settings) {
  using Parameterizer = CGAL::Surface_mesh_parameterization::ARAP_parameterizer_3<CgalMesh>;
  return parameterize_with_cgal(
      chart, Parameterizer(Parameterizer::Border_parameterizer(), Parameterizer::Solver_traits(), settings.lambda,
                           static_cast<unsigned int>(settings.iterations), settings.tolerance));
}

}  // namespace papilla::param_detail
