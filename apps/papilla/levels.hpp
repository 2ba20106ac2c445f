// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <optional>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/meshing/simplify.hpp"
#include "verb.hpp"

namespace papilla::app {

/// The options --lod, --lod-tolerances and --lod-nodes.
struct LevelOptions {
  std::optional<int> count;  ///< Levels beside the finest, each within four times the tolerance of the one before.
  std::vector<double> tolerances_mm;  ///< Or these, ascending.
  bool as_nodes = false;              ///< levels_to_nodes() instead of MSFT_lod.

  void add_to(CLI::App& verb);
  bool asked() const noexcept { return count || !tolerances_mm.empty(); }
};

/// Gives every part its simplified mesh and coarser levels, the levels_of_detail() of the mesh that it has now. A level
/// that keeps more than 90 % of the triangles of the one before is left out; a printed line says so. The screen
/// coverage of a level is where its tolerance takes one of 2000 pixels, about what a headset shows from top to bottom:
/// diagonal / (2000 tolerance).
/// @param results In the order of the parts; emptied. @param finest_mm Tolerance of `results`; 0 with --lod: its levels
///        start from 1e-4 of the largest part's diagonal.
/// @return {part, level, tolerance_mm, triangles, max_deviation_mm, screen_coverage} a line; also printed.
/// @throws UsageError when the tolerances don't ascend from `finest_mm`; InvalidInput naming the part.
Json add_levels(Scene& scene, std::vector<SimplifyResult>& results, const LevelOptions& options,
                const SimplifyOptions& simplify, double finest_mm, const Console& console);

/// For programs that don't know MSFT_lod: every level becomes a part, and each node that shows one keeps its place and
/// gets a child a level, named NAME_LOD0, NAME_LOD1, ... All of them are shown.
void levels_to_nodes(Scene& scene);

}  // namespace papilla::app
