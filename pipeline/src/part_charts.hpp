// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "papilla/meshing/chart_cuts.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/param/chart_memory.hpp"
#include "papilla/pipeline/unwrap_method.hpp"

namespace papilla::detail {

/// Of the time for a part, for progress.
inline constexpr double k_share_of_charts = 0.5;

/// What several ways to chart and map one part have in common.
struct PartMemory {
  std::optional<ChartSegmenter> segmenter;  ///< Made when charts are not in the cache.
  std::optional<ChartHalver> halver;        ///< Made when a chart has no map.
  std::optional<CutOpener> opener;          ///< Made when charts are mapped.
  ChartMemory maps;
};

/// Halves charts that have no valid map, or none worth having, a few times; the last map stays whatever it is.
Flattening map_or_halve(const TriangleMesh& mesh, ChartSet charts, MethodOptions options, int most_halvings,
                        PartMemory& memory, std::vector<ChartChoice>& choices);

/// Charts of the segmentation that the options ask for, with their map.
Flattening chart_and_map(const TriangleMesh& mesh, const MethodOptions& o, const PartContext& context,
                         PartMemory& memory, FlattenedPart& part);

}  // namespace papilla::detail
