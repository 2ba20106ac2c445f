// SPDX-License-Identifier: MIT
#include "papilla/pipeline/level_scenes.hpp"

#include <algorithm>
#include <set>

#include "papilla/pipeline/part_statistics.hpp"

namespace papilla {

double coverage_of_tolerance(double size_mm, double tolerance_mm) {
  constexpr double k_picture_height_px = 2000;
  return std::min(1.0, size_mm / (k_picture_height_px * tolerance_mm));
}

std::vector<double> level_tolerances(std::span<const LevelReport> levels) {
  std::set<double> tolerances;
  for (const LevelReport& level : levels)
    if (level.level > 0) tolerances.insert(level.tolerance_mm);
  return {tolerances.begin(), tolerances.end()};
}

LevelScene scene_of_level(const Scene& scene, std::span<const LevelReport> levels, double tolerance_mm) {
  std::vector<std::size_t> chosen(scene.parts.size(), 0);
  for (const LevelReport& level : levels)
    if (level.level > 0 && level.tolerance_mm <= tolerance_mm)
      chosen[level.part] = std::max(chosen[level.part], level.level);
  LevelScene result{scene, tolerance_mm, 0};
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    Part& part = result.scene.parts[i];
    if (chosen[i] > 0) part.mesh = std::move(part.levels[chosen[i] - 1].mesh);
    part.levels.clear();
  }
  result.screen_coverage = coverage_of_tolerance(scene_bounds(scene).diagonal(), tolerance_mm);
  return result;
}

}  // namespace papilla
