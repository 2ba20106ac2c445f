// SPDX-License-Identifier: MIT
#include "papilla/pipeline/part_statistics.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "papilla/core/error.hpp"

namespace papilla {

std::vector<MeshStatistics> part_statistics(const Scene& scene, const ProgressCallback& progress) {
  std::vector<MeshStatistics> result(scene.parts.size());
  oneapi::tbb::parallel_for(std::size_t{0}, scene.parts.size(), [&](std::size_t i) {
    try {
      result[i] = mesh_statistics(scene.parts[i].mesh);
    } catch (const InvalidInput& error) {
      throw InvalidInput("part '" + scene.parts[i].name + "': " + error.what());
    }
  });
  report_progress(progress, "measure", 1);
  return result;
}

MeshStatistics total_statistics(const std::vector<MeshStatistics>& parts) {
  MeshStatistics total;
  total.has_uv = !parts.empty();
  for (const MeshStatistics& s : parts) {
    total.triangles += s.triangles;
    total.vertices += s.vertices;
    total.components += s.components;
    total.boundary_loops += s.boundary_loops;
    total.genus += s.genus;
    total.nonmanifold_edges += s.nonmanifold_edges;
    total.degenerate_triangles += s.degenerate_triangles;
    total.duplicate_triangles += s.duplicate_triangles;
    total.flipped_edges += s.flipped_edges;
    total.t_junctions += s.t_junctions;
    total.aspect_max = std::max(total.aspect_max, s.aspect_max);
    total.has_uv = total.has_uv && s.has_uv;
  }
  return total;
}

}  // namespace papilla
