// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "disk_chart.hpp"

namespace papilla::param_detail {

/// The map of one chart up to similarity, or why there is none.
struct ConformalMap {
  std::vector<Vec2> uv;  ///< Per vertex; empty when `failure` says why.
  std::string failure;
};

/// @param chart connected, genus 0, with a border.
ConformalMap solve_lscm_cgal(const ChartSurface& chart);
ConformalMap solve_lscm_hermitian(const ChartSurface& chart);

}  // namespace papilla::param_detail
