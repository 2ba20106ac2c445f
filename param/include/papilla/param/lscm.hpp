// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/deadline.hpp"
#include "papilla/param/chart_memory.hpp"
#include "papilla/param/flattening.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla {

/// Who solves the least squares problem. Both pin two border vertices far apart.
enum class LscmSolver {
  hermitian,  ///< One complex Hermitian system of a row per vertex; triangles weighted by area, as in the paper.
  cgal,       ///< CGAL::Surface_mesh_parameterization::LSCM_parameterizer_3; triangles weighted by area squared.
};

struct LscmOptions {
  UpAxis up = UpAxis::z;
  LscmSolver solver = LscmSolver::hermitian;
  Deadline deadline;              ///< Charts not begun by then are projected; one that is begun is finished.
  ChartMemory* memory = nullptr;  ///< Charts that it has are not mapped again.
  /// What a chart gets that has no valid map: one as flatten_best() makes, or planar projections of its pieces when it
  /// is no disk, with a note; or, when false, an exception.
  bool fall_back = true;
  TriplanarOptions projection;  ///< Of the fallback; its `up` is taken from here.
};

/// Least squares conformal map of every chart: the complex number U_j of each vertex minimises
///     Σ_T w_T | W_1 U_1 + W_2 U_2 + W_3 U_3 |²,   W_j = the edge opposite to corner j in the triangle's plane,
/// up to translation, rotation and scale. Each chart is then scaled so that its uv area is its area in space (mm²),
/// and turned so that v follows grain_direction() on the area average.
///
/// Guarantees: what Flattening promises; every chart has no flipped triangle and does not overlap itself. A chart for
/// which the solver gives no finite map, a flipped triangle or an overlap, and a chart that is not a connected,
/// orientable piece of genus 0 with a border, is refused or falls back as the options say; holes are welcome.
/// Triangles without area get finite uv and count for nothing.
/// Good input: charts of moderate curvature. Conformal maps keep angles, not sizes: caps of a sphere beyond a
/// hemisphere and long fingers shrink without bound; LSCM may then also flip triangles. Cost: one sparse factorization
/// per chart, O(n^1.5) time, about 1.2 kB (hermitian) or 2 kB (cgal) per vertex. Charts run in parallel; the result
/// does not depend on the number of threads. Trace: one sample, error = Σ A (σ1 - σ2)² / Σ A of the scaled maps; charts
/// that fell back are left out. Paper: B. Lévy, S. Petitjean, N. Ray, J. Maillot, Least squares conformal maps for
/// automatic texture atlas generation, SIGGRAPH 2002.
///
/// @param charts one number below charts.count for every triangle.
/// @throws InvalidInput for a mesh or chart set that breaks these preconditions; without fall_back also for a chart of
/// the wrong
///         topology, naming chart and triangle; SolverFailure for one that has no valid map.
Flattening flatten_lscm(const TriangleMesh& mesh, const ChartSet& charts, const LscmOptions& options = {});

}  // namespace papilla
