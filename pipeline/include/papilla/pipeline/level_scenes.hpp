// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/pipeline/simplify_scene.hpp"

namespace papilla {

/// The share of the picture's height below which something of that size hides a tolerance: there it takes one of 2000
/// pixels, about what a headset shows from top to bottom. size / (2000 tolerance), at most 1.
double coverage_of_tolerance(double size_mm, double tolerance_mm);

/// A scene whose parts are coarser levels of detail.
struct LevelScene {
  Scene scene;
  double tolerance_mm = 0;     ///< Within which they all are.
  double screen_coverage = 0;  ///< coverage_of_tolerance() of the scene's diagonal.
};

/// For files of their own: every part of a scene as its coarsest level within a tolerance, or as it is where it has
/// none, without levels. Everything else stays.
/// @param levels  of add_levels() for this scene.
LevelScene scene_of_level(const Scene& scene, std::span<const LevelReport> levels, double tolerance_mm);

/// Tolerances for which some part has a level, ascending.
std::vector<double> level_tolerances(std::span<const LevelReport> levels);

}  // namespace papilla
