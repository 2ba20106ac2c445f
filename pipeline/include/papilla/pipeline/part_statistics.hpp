// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/meshing/statistics.hpp"

namespace papilla {

/// The statistics of every part of a scene, measured in parallel; in the order of the parts.
/// @throws InvalidInput naming the part.
std::vector<MeshStatistics> part_statistics(const Scene& scene, const ProgressCallback& progress);

/// The statistics of several meshes together: counters added, the largest aspect, has_uv when all have uv.
MeshStatistics total_statistics(const std::vector<MeshStatistics>& parts);

}  // namespace papilla
