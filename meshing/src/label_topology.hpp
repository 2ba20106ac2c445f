// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/meshing/chart_topology.hpp"

namespace papilla::detail {

/// The topology of every label's triangles, given their opposite half-edges within the labels.
std::vector<ChartTopology> label_topologies(std::span<const Index> opposite, std::span<const std::uint32_t> labels,
                                            std::uint32_t count);

}  // namespace papilla::detail
