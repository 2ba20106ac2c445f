// SPDX-License-Identifier: GPL-3.0-or-later
#include "levels.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "exit_code.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/levels_of_detail.hpp"
#include "papilla/meshing/mesh_bounds.hpp"

namespace papilla::app {
namespace {

constexpr double k_level_factor = 4;        ///< Between the tolerances of --lod: about a quarter of the triangles.
constexpr double k_first_tolerance = 1e-4;  ///< Of the largest part's diagonal.
constexpr double k_picture_height_px = 2000;
constexpr double k_most_kept = 0.9;

std::vector<double> tolerances(const Scene& scene, const LevelOptions& options, double finest_mm) {
  std::vector<double> result = options.tolerances_mm;
  if (options.count) {
    double largest = 0;
    for (const Part& part : scene.parts) largest = std::max(largest, bounds_of(part.mesh).diagonal());
    double tolerance = finest_mm > 0 ? k_level_factor * finest_mm : k_first_tolerance * largest;
    for (int level = 0; level < *options.count && tolerance > 0; ++level, tolerance *= k_level_factor)
      result.push_back(tolerance);
  }
  double last = finest_mm;
  for (const double tolerance : result) {
    if (!(tolerance > last))
      throw UsageError(fmt::format("simplify: --lod-tolerances: {} does not exceed {} mm", tolerance, last));
    last = tolerance;
  }
  return result;
}

/// A level, and whether it is fewer triangles enough to be kept.
struct Level {
  double tolerance_mm = 0;
  SimplifyResult result;
  bool kept = true;
};

std::vector<Level> coarser_levels(const Part& part, std::size_t finest_triangles, const std::vector<double>& tolerances,
                                  const SimplifyOptions& simplify) {
  std::vector<Level> levels;
  if (part.mesh.triangles.empty()) return levels;
  std::vector<SimplifyResult> all = levels_of_detail(part.mesh, tolerances, simplify);
  std::size_t last = finest_triangles;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t triangles = all[i].mesh.triangles.size();
    const bool kept = triangles > 0 && static_cast<double>(triangles) <= k_most_kept * static_cast<double>(last);
    if (kept) last = triangles;
    levels.push_back({tolerances[i], std::move(all[i]), kept});
  }
  return levels;
}

}  // namespace

void LevelOptions::add_to(CLI::App& verb) {
  auto* number =
      verb.add_option("--lod", count,
                      "So many coarser levels, each within four times the tolerance of the last; one that has not a "
                      "tenth fewer triangles is left out, and said so")
          ->type_name("N")
          ->check(CLI::Range(1, 8));
  verb.add_option("--lod-tolerances", tolerances_mm, "Coarser levels within these ascending tolerances")
      ->type_name("MM,MM,...")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->excludes(number);
  verb.add_flag("--lod-nodes", as_nodes, "Levels as nodes NAME_LOD0, NAME_LOD1, ... instead of MSFT_lod");
}

Json add_levels(Scene& scene, std::vector<SimplifyResult>& results, const LevelOptions& options,
                const SimplifyOptions& simplify, double finest_mm, const Console& console) {
  const std::vector<double> wanted = tolerances(scene, options, finest_mm);
  std::vector<std::vector<Level>> levels(scene.parts.size());
  oneapi::tbb::parallel_for(std::size_t{0}, levels.size(), [&](std::size_t i) {
    try {
      levels[i] = coarser_levels(scene.parts[i], results[i].mesh.triangles.size(), wanted, simplify);
    } catch (const InvalidInput& error) {
      throw InvalidInput("part \"" + scene.parts[i].name + "\": " + error.what());
    }
  });
  Json json = Json::array();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    Part& part = scene.parts[i];
    const double size = bounds_of(part.mesh).diagonal();
    part.mesh = std::move(results[i].mesh);
    part.levels.clear();
    for (Level& level : levels[i]) {
      if (!level.kept) {
        console.print(fmt::format(
            "{:>10} {:>10} {:>12}  {}: no level within {:.4g} mm, it would not have a tenth less\n",
            level.result.triangles_before, level.result.mesh.triangles.size(), "-", part.name, level.tolerance_mm));
        continue;
      }
      const double coverage = std::min(1.0, size / (k_picture_height_px * level.tolerance_mm));
      const double deviation = level.result.deviation.bound();
      part.levels.push_back({std::move(level.result.mesh), coverage});
      json.push_back({{"part", part.name},
                      {"level", part.levels.size()},
                      {"tolerance_mm", level.tolerance_mm},
                      {"triangles", part.levels.back().mesh.triangles.size()},
                      {"max_deviation_mm", deviation},
                      {"screen_coverage", coverage}});
      console.print(fmt::format("{:>10} {:>10} {:>12.4g}  {} level {}\n", level.result.triangles_before,
                                part.levels.back().mesh.triangles.size(), deviation, part.name, part.levels.size()));
    }
  }
  return json;
}

void levels_to_nodes(Scene& scene) {
  const std::size_t parts = scene.parts.size(), nodes = scene.nodes.size();
  std::vector<std::vector<std::uint32_t>> of_part(parts);
  for (std::size_t i = 0; i < parts; ++i) {
    std::vector<PartLevel> levels = std::move(scene.parts[i].levels);
    scene.parts[i].levels.clear();
    for (std::size_t level = 0; level < levels.size(); ++level) {
      Part part = scene.parts[i];
      part.mesh = std::move(levels[level].mesh);
      part.name += fmt::format("_LOD{}", level + 1);
      part.id += fmt::format("_LOD{}", level + 1);
      of_part[i].push_back(static_cast<std::uint32_t>(scene.parts.size()));
      scene.parts.push_back(std::move(part));
    }
    if (!levels.empty()) of_part[i].insert(of_part[i].begin(), static_cast<std::uint32_t>(i));
  }
  for (std::size_t n = 0; n < nodes; ++n) {
    if (!scene.nodes[n].part || of_part[*scene.nodes[n].part].empty()) continue;
    const std::uint32_t shown = *scene.nodes[n].part;
    const std::string name = scene.nodes[n].name.empty() ? scene.parts[shown].name : scene.nodes[n].name;
    scene.nodes[n].part.reset();
    for (std::size_t level = 0; level < of_part[shown].size(); ++level) {
      Node child;
      child.name = fmt::format("{}_LOD{}", name, level);
      child.part = of_part[shown][level];
      scene.nodes[n].children.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
      scene.nodes.push_back(std::move(child));
    }
  }
}

}  // namespace papilla::app
