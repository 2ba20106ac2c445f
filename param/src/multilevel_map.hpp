// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "chart_pieces.hpp"
#include "papilla/core/deadline.hpp"
#include "papilla/core/trace.hpp"

namespace papilla::param_detail {

struct MultilevelOptions {
  int max_iterations = 50;
  double tolerance = 1e-3;
  std::size_t newton_vertices = 200'000;
  std::function<void(double)> progress;                           ///< Told the fraction that is done; may be empty.
  Deadline deadline;                                              ///< A chart without a map by then is a failure.
  bool only_when_rough = false;                                   ///< No iterations on a map that is smooth already.
  double energy_limit = std::numeric_limits<double>::infinity();  ///< A map with a larger mean energy is a failure.
  /// A map whose mean energy will hardly come below this is left unfinished: above it, perhaps overlapping itself.
  double give_up_energy = std::numeric_limits<double>::infinity();
};

struct MultilevelMap {
  std::vector<Vec2> uv;  ///< Per vertex; when `failure` says why there is none, empty, unless energy_limit refuses it.
  std::string failure;
  bool given_up = false;  ///< By give_up_energy: uv is above it, and need not be injective.
  StopReason stop = StopReason::converged;
  Trace trace;  ///< Error: mean symmetric Dirichlet energy of the whole chart, from the first map of it on.
};

/// A map of low symmetric Dirichlet energy that is injective: no triangle is flipped, and the chart does not overlap
/// itself. The chart is coarsened to a few triangles, these are mapped, and vertices come back in order, each to a
/// place where its triangles are positive; the map of every level is relaxed before the next one. With
/// ChartSurface::nearby, map_nearby() is tried first.
/// @param chart connected, of genus 0, with a border; coordinates around 1.
MultilevelMap map_multilevel(const ChartSurface& chart, const MultilevelOptions& options);

}  // namespace papilla::param_detail
