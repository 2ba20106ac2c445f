// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "disk_chart.hpp"

namespace papilla::param_detail {

/// The map of one chart up to similarity, or why there is none.
struct SolvedMap {
  std::vector<Vec2> uv;  ///< Per vertex; empty when `failure` says why.
  std::string failure;
};

struct ArapSettings {
  double lambda;
  int iterations;
  double tolerance;
};

/// @param chart connected, genus 0, with a border.
SolvedMap solve_lscm_hermitian(const ChartSurface& chart);
SolvedMap solve_lscm_cgal(const ChartSurface& chart);
SolvedMap solve_tutte_cgal(const ChartSurface& chart);
SolvedMap solve_mean_value_cgal(const ChartSurface& chart);
SolvedMap solve_arap_cgal(const ChartSurface& chart, const ArapSettings& settings);

}  // namespace papilla::param_detail
