// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/meshing/simplify.hpp"

namespace papilla {

/// Which coarser levels of detail parts get.
struct LevelOptions {
  std::optional<int> count;           ///< Levels beside the finest, each within four times the tolerance of the last.
  std::vector<double> tolerances_mm;  ///< Or these, ascending.

  bool asked() const noexcept { return count || !tolerances_mm.empty(); }
};

/// One level of one part.
struct LevelReport {
  std::uint32_t part = 0;
  std::size_t level = 0;  ///< From 1; 0: left out, because it would keep more than 90 % of the last one's triangles.
  double tolerance_mm = 0, max_deviation_mm = 0, screen_coverage = 0;
  std::size_t triangles_before = 0, triangles = 0;
};

/// Gives every part coarser levels: levels_of_detail() of `originals`, which its mesh was simplified from. The screen
/// coverage of a level is where its tolerance takes one of 2000 pixels, about what a headset shows from top to bottom:
/// diagonal / (2000 tolerance). Parts run in parallel.
/// @param originals In the order of the parts.
/// @param finest_mm Tolerance of the scene's meshes; 0 with `count`: levels start from 1e-4 of the largest diagonal.
/// @throws InvalidInput when the tolerances do not ascend from `finest_mm`; naming the part.
std::vector<LevelReport> add_levels(Scene& scene, std::span<const TriangleMesh> originals, const LevelOptions& options,
                                    const SimplifyOptions& simplify, double finest_mm);

/// For programs that do not know MSFT_lod: every level becomes a part, and each node that shows one keeps its place and
/// gets a child a level, named NAME_LOD0, NAME_LOD1, ... All of them are shown.
void levels_to_nodes(Scene& scene);

}  // namespace papilla
