// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/meshing/statistics.hpp"
#include "verb.hpp"

namespace papilla::app {

/// The statistics of every part of a scene, measured in parallel; in the order of the parts.
/// @throws InvalidInput naming the part.
std::vector<MeshStatistics> part_statistics(const Scene& scene, const ProgressCallback& progress);

/// The counters of a mesh, or of several: sums, the largest aspect, and has_uv when all have one.
Json counters_json(const MeshStatistics& statistics);
MeshStatistics total_statistics(const std::vector<MeshStatistics>& parts);

/// A row for people: the counters and `name`; header_row() heads the columns.
std::string header_row();
std::string counters_row(const std::string& name, const MeshStatistics& statistics);

}  // namespace papilla::app
