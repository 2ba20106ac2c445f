// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "chart_driver.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/param/best.hpp"

namespace papilla::param_detail {

/// @throws InvalidInput, in the name of `function`, for options out of range.
void check_best_options(const BestOptions& options, std::string_view function);

/// map_multilevel() of a chart in any place and of any size. The errors of its trace are sums over the chart.
/// @param mapped  counts its triangles.
ChartMap map_best(const ChartSurface& chart, const BestOptions& options, SharedProgress& mapped);

}  // namespace papilla::param_detail
