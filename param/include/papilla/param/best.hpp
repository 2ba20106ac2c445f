// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>

#include "papilla/core/deadline.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/param/chart_memory.hpp"
#include "papilla/param/flattening.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla {

/// Options of flatten_best(). All are dimensionless, so one set of values serves every size of chart.
struct BestOptions {
  UpAxis up = UpAxis::z;
  /// Stop when an iteration lowers the energy by less than this fraction, and its slope promised no more, or when full
  /// steps have less than it still to gain, by how the last one's gain and the slopes go down; in (0, 1).
  double tolerance = 1e-3;
  int max_iterations = 50;  ///< Newton iterations on the whole chart; at least 0.
  /// Levels with more vertices are relaxed vertex by vertex only: a step takes 2 kB of memory per vertex.
  std::size_t newton_vertices = 200'000;
  ProgressCallback progress;      ///< Told the fraction of the triangles that are mapped; may be empty.
  Deadline deadline;              ///< Charts that have no map by then are projected, the others are left as they are.
  ChartMemory* memory = nullptr;  ///< Charts that it has are not mapped again.
  /// Another map of the same triangles, in millimetres, with other cuts: charts begin there where that leads to a valid
  /// map. For callers that try one cut after the other. Null: every chart begins with itself.
  const CornerAttribute<Vec2>* nearby = nullptr;
  /// A chart with a larger E / ΣA counts as one without a valid map, for callers that would rather cut it; at least 4.
  double energy_limit = std::numeric_limits<double>::infinity();
  /// A chart whose E - 4 ΣA [mm²] will hardly come below this is left unfinished: above it, perhaps overlapping itself.
  /// For callers that try charts and have no use for such.
  double give_up_excess_mm2 = std::numeric_limits<double>::infinity();
  bool fall_back = true;        ///< Project charts that are no disk, with a note; false: throw.
  TriplanarOptions projection;  ///< Of the fallback; its `up` is taken from here.
};

/// The map of every chart with the lowest distortion that keeps it valid: minimises the symmetric Dirichlet energy
///     E = Σ_T A_T (σ1² + σ2² + σ1⁻² + σ2⁻²)
/// with σ1, σ2 the singular values of the map on triangle T of area A_T. E is at least 4 ΣA, with equality for
/// isometries only. Charts are then scaled so that their uv area is their area in space (mm²), and turned so that v
/// follows grain_direction() on the area average.
///
/// Guarantees: what Flattening promises; no triangle flipped or collapsed, no chart that overlaps itself, however
/// curved the chart. Triangles without area count as having a height of 1e-10 of their longest edge: they get uv of
/// little more area than that, and hold no others up. Breaks down: a chart that is not a connected, orientable piece of
/// genus 0 with a border (holes are welcome) has no such map and falls back or is refused; so does one with two edges
/// between the same two vertices, and one whose parts shrink below what doubles resolve. Charts that lie over
/// themselves when flattened freely (spiral ramps, knots of strips) are kept apart; how they are laid out then is a
/// local optimum among many. Good input: any welded disk. Strongly curved charts (heads, hands) have maps of E / ΣA = 5
/// to 10 whatever one does: more charts help, iterations do not.
///
/// Method: the chart is coarsened vertex by vertex to a few triangles, these are mapped by Tutte's method, and the
/// vertices come back in order, each into the kernel of its ring; every level is relaxed, first vertex by vertex, then
/// (up to `newton_vertices`) by projected Newton steps on a nested-dissection factorization, with a line search that
/// crosses no flip and goes further than the model says where the energy bends less. Slivers (doubled area below 1e-4
/// of the longest edge squared, area below 1e-3 of the mean) count as having 1e-3 of the mean area until all vertices
/// are relaxed; then the vertex opposite to the longest edge goes to where their own shape puts it. Charts that come
/// out deep (E / ΣA above 15) begin with 200 vertices, and what leads away from their border pulls harder in Tutte's
/// map; one with a single end (a finger, a bag) begins as a tube instead, on its finest level: its wall goes to a
/// cylinder by harmonic weights, its rings to circles of the area inside them, whose scales are then set by Newton
/// steps. From the first level on whose border runs into itself, a barrier between the edges of the border keeps it
/// apart; where vertices find no room then, the map begins again from an earlier level or a finer base. With `nearby`
/// Newton's steps begin at that map instead: where seams are closed, the triangles around are put together as rigidly
/// as they go (O. Sorkine, M. Alexa, 2007), where they are opened, their sides are drawn apart, what is rough then is
/// smoothed by sweeps over the vertices, and the border is kept apart from the first step on. Such a chart may end in
/// another local optimum, better more often than not. Cost: O(n) for coarsening and relaxing, O(n^1.5) per Newton step;
/// about 2 kB per vertex. Charts, branches of the factorization and sums run in parallel; the result does not depend on
/// the number of threads. Trace: error = E / ΣA, from the first map of the whole chart on. Papers: J. Smith, S.
/// Schaefer, Bijective parameterization with free boundaries, 2015; M. Rabinovich et al., Scalable locally injective
/// mappings, 2017; H. Shen et al., Progressive embedding, 2019; B. Smith et al., Analytic eigensystems for isotropic
/// distortion energies, 2019.
///
/// @param charts one number below charts.count for every triangle.
/// @throws InvalidInput for a mesh, chart set or option that breaks these preconditions; without fall_back also for a
///         chart of the wrong topology, naming chart and triangle; SolverFailure for one that has no valid map.
Flattening flatten_best(const TriangleMesh& mesh, const ChartSet& charts, const BestOptions& options = {});

}  // namespace papilla
