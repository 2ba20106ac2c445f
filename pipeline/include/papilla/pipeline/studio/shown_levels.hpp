// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/pipeline/studio/shown_mesh.hpp"

namespace papilla {

class StageCache;

/// Fewer triangles of a ShownMesh, over its own vertices.
struct ShownLevel {
  double screen_coverage = 0;          ///< PartLevel::screen_coverage.
  std::vector<std::uint32_t> indices;  ///< 3 a triangle.
};

/// Levels of detail of what is shown, finest first, by add_levels(): within 1/2000 of the diagonal of its box and 4, 16
/// and 64 times as much, which make way where the surface takes the picture's height, a quarter of it, a 16th and a
/// 64th. Vertices keep place and uv; of those that differ in the normal alone, the one with the nearest normal is
/// taken. Borders and seams of uv stay closed. Levels with more than 90 % of the triangles of the one before are left
/// out. Cost: that of levels_of_detail(). Deterministic.
/// @param cache remembers levels; may be null. @throws InvalidInput as simplify(); Cancelled.
std::vector<ShownLevel> shown_levels(const ShownMesh& mesh, const StageCache* cache = nullptr,
                                     const ProgressCallback& progress = {});

}  // namespace papilla
