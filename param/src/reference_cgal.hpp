// SPDX-License-Identifier: MIT
#pragma once

#include "lscm_solvers.hpp"

namespace papilla::param_detail {

struct ArapSettings {
  double lambda;
  int iterations;
  double tolerance;
};

/// @param chart connected, genus 0, with a border.
ConformalMap solve_tutte_cgal(const ChartSurface& chart);
ConformalMap solve_mean_value_cgal(const ChartSurface& chart);
ConformalMap solve_arap_cgal(const ChartSurface& chart, const ArapSettings& settings);

}  // namespace papilla::param_detail
