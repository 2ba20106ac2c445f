// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "chart_driver.hpp"
#include "papilla/param/chart_memory.hpp"

namespace papilla {
namespace param_detail {

/// What one chart came to.
struct MappedChart {
  CornerAttribute<Vec2> uv;           ///< Triangles in the order of the chart.
  std::vector<std::uint32_t> pieces;  ///< Chart number within this one, per triangle; empty: all 0.
  std::uint32_t piece_count = 1;
  std::string failure;        ///< Why the method gave no map.
  std::vector<Vec2> refused;  ///< A valid map of too much distortion.
  std::string instead;        ///< What the chart got then.
  bool wrong_topology = false;
  bool given_up = false;  ///< ChartMap::given_up.
  double area = 0;
  StopReason stop = StopReason::direct;
  Trace trace;
  MethodChoice choice;
};

}  // namespace param_detail

struct ChartMemory::Maps {
  struct Kept {
    std::vector<Index> triangles;
    param_detail::MappedChart chart;
  };
  std::unordered_map<Index, Kept> by_first_triangle;

  /// Whether the chart has a map that is kept, of a mean energy of at most `energy_limit`; `chart` then is that map.
  /// May run in parallel.
  bool recall(std::span<const Index> triangles, const param_detail::ChartSurface& surface, double energy_limit,
              param_detail::MappedChart& chart) const;

  /// Does nothing for charts without a map by the method, or one that was given up.
  void keep(std::span<const Index> triangles, param_detail::MappedChart chart);
};

}  // namespace papilla
