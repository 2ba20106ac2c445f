// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chart_pieces.hpp"

namespace papilla::param_detail {

/// The map of one chart up to similarity, or why there is none.
struct ConformalMap {
  std::vector<Vec2> uv;  ///< Per vertex; empty when `failure` says why.
  std::string failure;
};

/// The chart's border loops, each as the list of its vertices in order; the longest (in space) first.
std::vector<std::vector<Index>> border_loops(const ChartSurface& chart);

/// @param chart connected, genus 0, with a border.
ConformalMap solve_lscm_cgal(const ChartSurface& chart);
ConformalMap solve_lscm_hermitian(const ChartSurface& chart);

}  // namespace papilla::param_detail
