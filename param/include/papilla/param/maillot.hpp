// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/deadline.hpp"
#include "papilla/param/chart_choice.hpp"
#include "papilla/param/chart_memory.hpp"
#include "papilla/param/flattening.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla {

/// How the energy is lowered. Both start from the same map and stop by the same rule.
enum class MaillotSolver {
  gradient_descent,  ///< The source's: along the negative gradient, with line search.
  gauss_newton,      ///< Sparse Gauss-Newton steps on a nested-dissection factorization, with the same line search.
};

/// The map that is started from.
enum class MaillotStart {
  coarse_to_fine,  ///< As flatten_best() has it, before its last iterations where these change little: valid on every
                   ///< disk.
  conformal,       ///< Least squares conformal.
  planar,          ///< Projection along the chart's mean normal, in true size.
};

struct MaillotOptions {
  UpAxis up = UpAxis::z;
  double length_weight = 0.5;  ///< φ, in [0, 1].
  MaillotSolver solver = MaillotSolver::gauss_newton;
  /// Where the start is no valid map of a chart, the descent starts from coarse_to_fine there, and `choices` says so;
  /// with allow_flips it starts from what was asked for all the same.
  MaillotStart start = MaillotStart::coarse_to_fine;
  double tolerance = 1e-3;   ///< Stop when E falls by less than this fraction in an iteration, or below 1e-12 of the
                             ///< area; in (0, 1).
  int max_iterations = 500;  ///< At least 0.
  Deadline deadline;         ///< As BestOptions has it.
  ChartMemory* memory = nullptr;  ///< Charts that it has are not mapped again.
  /// E has no wall against triangles that collapse. The descent ends where it would raise the mean symmetric Dirichlet
  /// energy (of the map scaled to equal area) above this multiple of the start's; at least 1, or 0: no limit.
  double distortion_limit = 1.004;
  bool allow_flips = false;     ///< No limit and no line search for validity, the source literally.
  bool fall_back = true;        ///< What a chart without a valid map gets: as in LscmOptions.
  TriplanarOptions projection;  ///< Of the fallback; its `up` is taken from here.
};

struct MaillotResult {
  /// Trace: error = E in mm², over all charts; its first sample is the start's.
  Flattening flattening;
  double start_energy = 0;         ///< E of the start in mm², over the charts that the method mapped.
  double end_energy = 0;           ///< And of the result: what the descent gained is the difference.
  double length_energy = 0;        ///< E_l in mm², over all charts.
  double area_energy = 0;          ///< E_f in mm².
  double squared_edges = 0;        ///< Σ D² in mm²: E_l divided by it is the usual relative measure.
  std::size_t flipped = 0;         ///< Triangles that are turned over (only with allow_flips).
  std::size_t invalid_charts = 0;  ///< Charts with such triangles, or that overlap themselves (only with allow_flips).
  std::vector<ChartChoice> choices;  ///< Per chart: where the descent started, and E before and after it.
};

/// The source literally: gradient descent with line search, from its own start, triangles may turn over, no limit of
/// distortion.
/// @param start conformal or planar.
MaillotOptions maillot_as_written(MaillotStart start, double length_weight = 0.5);

/// Maps every chart by lowering the energy of Maillot, Yahia and Verroust,
///     E = φ E_l + (1-φ) E_f,
///     E_l = Σ_edges (d² - D²)² / D²,      E_f = Σ_triangles (det - A)² / A,
/// with d, D the length of an edge in uv and in space, det the signed doubled area in uv and A the doubled area in
/// space, every edge and triangle counted once. Charts keep the scale that the minimum has (not that of equal area),
/// and are turned so that v follows grain_direction() on the area average.
///
/// Gradients: ∂E_l/∂m_i = 4 Σ_k (d² - D²) / D² (m_i - m_k), ∂E_f/∂m_i = 2 Σ_T (det - A) / A ∂det/∂m_i. Edges without
/// length and triangles without area have no weight.
///
/// Guarantees: what Flattening promises; E never rises; without allow_flips no triangle is flipped (the line search
/// stops before the first determinant reaches zero) and no chart overlaps itself: the descent ends before it does, with
/// StopReason::line_search_stalled, as it does at the distortion limit.
/// Breaks down: φ = 0 has no unique minimum (every map that keeps areas is one): the result depends on the start. φ = 1
/// folds strongly curved charts when it may: with allow_flips, `flipped` counts it; without, the descent then stalls at
/// the fold. Good input: as for flatten_best(). Gradient descent needs thousands of steps where Gauss-Newton needs
/// five. Cost: per iteration O(n) and O(n^1.5). Parallel; the result does not depend on the number of threads. Source:
/// J. Maillot, H. Yahia, A. Verroust, Interactive texture mapping, SIGGRAPH 1993, equations as corrected in the thesis
/// on haptic textures (4.13)-(4.21).
///
/// @param charts one number below charts.count for every triangle.
/// @throws InvalidInput for a mesh, chart set or option that breaks these preconditions; without fall_back also for a
///         chart of the wrong topology, naming chart and triangle; SolverFailure for one that has no valid map.
MaillotResult flatten_maillot(const TriangleMesh& mesh, const ChartSet& charts, const MaillotOptions& options = {});

}  // namespace papilla
