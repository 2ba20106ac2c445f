// SPDX-License-Identifier: MIT
#include "papilla/param/chart_memory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapped_chart.hpp"

namespace papilla {

ChartMemory::ChartMemory() : maps_(std::make_unique<Maps>()) {}
ChartMemory::~ChartMemory() = default;

bool ChartMemory::Maps::recall(std::span<const Index> triangles, const param_detail::ChartSurface& surface,
                               double energy_limit, param_detail::MappedChart& chart) const {
  const auto kept = by_first_triangle.find(triangles.front());
  if (kept == by_first_triangle.end()) return false;
  if (!std::ranges::equal(kept->second.triangles, triangles)) return false;
  if (kept->second.chart.uv.indices != surface.triangles) return false;  // cut in another way
  const Trace& trace = kept->second.chart.trace;
  if (std::isfinite(energy_limit) && !trace.empty() && trace.back().error > energy_limit * kept->second.chart.area)
    return false;
  chart = kept->second.chart;
  return true;
}

void ChartMemory::Maps::keep(std::span<const Index> triangles, param_detail::MappedChart chart) {
  if (!chart.failure.empty() || chart.given_up || triangles.empty()) return;
  by_first_triangle[triangles.front()] = {{triangles.begin(), triangles.end()}, std::move(chart)};
}

}  // namespace papilla
