// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_report.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "papilla/core/error.hpp"

namespace papilla::app {

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

Json counters_json(const MeshStatistics& s) {
  return {{"triangles", s.triangles},
          {"vertices", s.vertices},
          {"components", s.components},
          {"boundary_loops", s.boundary_loops},
          {"genus", s.genus},
          {"nonmanifold_edges", s.nonmanifold_edges},
          {"degenerate_triangles", s.degenerate_triangles},
          {"duplicate_triangles", s.duplicate_triangles},
          {"flipped_edges", s.flipped_edges},
          {"t_junctions", s.t_junctions},
          {"aspect_max", s.aspect_max},
          {"has_uv", s.has_uv}};
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

std::string header_row() {
  return fmt::format("{:>9} {:>9} {:>5} {:>6} {:>6} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9} {:>3}  part\n", "triangles",
                     "vertices", "comp", "loops", "genus", "nonman", "degen", "dupl", "flipped", "T-junc", "aspect",
                     "uv");
}

std::string counters_row(const std::string& name, const MeshStatistics& s) {
  return fmt::format("{:>9} {:>9} {:>5} {:>6} {:>6} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9.4g} {:>3}  {}\n", s.triangles,
                     s.vertices, s.components, s.boundary_loops, s.genus, s.nonmanifold_edges, s.degenerate_triangles,
                     s.duplicate_triangles, s.flipped_edges, s.t_junctions, s.aspect_max, s.has_uv ? "yes" : "no",
                     name);
}

}  // namespace papilla::app
