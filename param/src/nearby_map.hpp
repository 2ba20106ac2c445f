// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "multilevel_map.hpp"

namespace papilla::param_detail {

/// As map_multilevel(), but Newton's steps begin at stitched_start(), after sweeps over the vertices where that is
/// rough: what takes a fraction of the time where most of the chart stays as it was. The border is kept apart from the
/// first step on.
/// @param chart has a map nearby. @return nothing where that does not lead to a valid map.
std::optional<MultilevelMap> map_nearby(const ChartSurface& chart, const MultilevelOptions& options);

}  // namespace papilla::param_detail
