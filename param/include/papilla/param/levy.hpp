// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "papilla/core/deadline.hpp"
#include "papilla/param/chart_choice.hpp"
#include "papilla/param/chart_memory.hpp"
#include "papilla/param/flattening.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla {

/// c(i,k), i ≠ k, of the smoothness condition; c(k,k) = -Σ_i c(i,k).
enum class LevyWeights {
  uniform,     ///< 1: what the source calls harmonic.
  cotangent,   ///< (cot α + cot β) / 2; may be negative, which forfeits validity.
  mean_value,  ///< (tan γ/2 + tan δ/2) / length [Floater 2003]; not symmetric.
};

enum class LevyBorder {
  convex,    ///< On a circle of the chart's area, in proportion to its length.
  released,  ///< As convex until R = 0, then free: the source's two stages.
  free,      ///< From the start; two or more pins fix position and scale.
};

/// How u and v are kept at right angles.
enum class LevyCoupling {
  automatic,  ///< Conformal in charts where it can be solved for (free border, direct, no iso line), else orthogonal.
  conformal,  ///< Σ A |∇v - ∇u turned by 90°|²: right angles and gradients of equal length; linear in u and v together.
  orthogonal,  ///< The source's Σ A (∇u·∇v)²; bilinear: rounds.
};

enum class LevySolver {
  gauss_seidel,  ///< The source's descent: one unknown after the other.
  direct,        ///< Sparse factorizations; their symbolic part is shared by all rounds.
};

/// A vertex that has a place.
struct LevyPin {
  Index vertex = 0;  ///< Of the mesh; on seams, in every chart that has it.
  Vec2 uv;           ///< Millimetres.
};

/// Vertices that share their u, or their v.
struct LevyIsoLine {
  std::vector<Index> vertices;
  bool is_u = true;             ///< u is the same for all; false: v.
  std::optional<double> value;  ///< In millimetres; not given: found.
};

struct LevyOptions {
  UpAxis up = UpAxis::z;
  LevyWeights weights = LevyWeights::mean_value;
  LevyBorder border = LevyBorder::free;
  LevyCoupling coupling = LevyCoupling::automatic;
  LevySolver solver = LevySolver::direct;
  double smoothness = 0;     ///< Weight of R; not negative.
  double orthogonality = 1;  ///< Weight of the coupling; not negative.
  double length = 1;         ///< Weight of the length condition; not negative.
  double tolerance = 1e-3;   ///< Stop when a round lowers the sum by less than this fraction; in (0, 1).
  int max_rounds = 10;       ///< Alternations between u and v; at least 1.
  /// Rounds that ask for lengths anew, along the directions just found, where `length` counts and the border is free,
  /// the coupling conformal, the solver direct; at least 0: evenness of lengths is all.
  int length_rounds = 1;
  int max_sweeps = 1000;          ///< Of gauss_seidel, per round; at least 1.
  Deadline deadline;              ///< As BestOptions has it.
  ChartMemory* memory = nullptr;  ///< Charts that it has are not mapped again.
  /// With pins the chart keeps the place and scale that they give. Pins on a free border must differ in u and in v.
  std::vector<LevyPin> pins;
  std::vector<LevyIsoLine> iso_lines;
  bool fall_back = true;        ///< What a chart without a valid map gets: as in LscmOptions.
  TriplanarOptions projection;  ///< Of the fallback; its `up` is taken from here.
};

struct LevyResult {
  /// Trace: error = the sum F in mm², over all charts, after each round or sweep; with rounds of lengths the sum
  /// Σ_T A |∇m - λ R_T|², of the first map and after each round.
  Flattening flattening;
  /// The parts of F at the end, without their weights, in mm²; 0 where the weight is 0 (smoothness: and the border
  /// free).
  double smoothness = 0, orthogonality = 0, length = 0;
  /// Per chart "levy conformal", "levy orthogonal" or "levy smooth" (R alone), and why.
  std::vector<ChartChoice> choices;
};

/// The source's functional and way: F with all three weights 1, c(i,k) = 1, right angles as (∇u·∇v)², from R = 0 on the
/// convex border, one unknown after the other, u and v in turn.
LevyOptions levy_as_written(LevyBorder border = LevyBorder::convex, LevySolver solver = LevySolver::gauss_seidel);

/// Smooth interpolation of Lévy and Mallet: u and v minimise
///     F = smoothness R + orthogonality O + length S L,
///     R = Σ_k [(Σ_i c(i,k) u_i)² + (Σ_i c(i,k) v_i)²]   over interior vertices k,
///     O = Σ_T A (∇u·∇v)²  or  Σ_T A |∇v - ∇u turned by 90°|², as `coupling` says,
///     L = Σ_e (A_1 + A_2) / 3 [(Y_1 u + Y_2 u)² + (Y_1 v + Y_2 v)²] / h²   over interior edges e,
/// where Y_1, Y_2 are the derivatives across e in its two triangles, each away from e: their sum is how much the
/// gradient jumps (along the edge a continuous map's gradients always agree); h is the distance of the triangles'
/// middles, so that L measures second derivatives and does not depend on how fine the mesh is; S is 1.2 % of the
/// chart's area.
///
/// Free border, conformal, direct, no iso lines: one Hermitian system. All terms are homogeneous, so without pins the
/// map is the one of least F among those of given inertia about their middle (inverse iteration, three solves). A chart
/// with one pin of several gets that map, too, moved to the pin: F does not change with it.
/// F makes lengths even, not right. Then each of `length_rounds` asks for lengths along the directions that it finds:
///     Σ_T A |∇m - λ R_T|² + smoothness R  ->  least,
/// R_T the rotation nearest to ∇m before the round, λ the mean length of the first map's gradients. This is linear, one
/// real factorization serves u and v of all rounds, and its limit is the map as rigid as possible. A round that would
/// raise the symmetric Dirichlet energy is not taken, and is the last.
/// Convex border without coupling and length, no pins: the minimum is R = 0, found from one linear system.
/// Else: u is found with v held, then v with u held, in rounds, O being (∇u·∇v)². Rounds on a free border start from
/// the least squares conformal map, those on a released one from R = 0 on the circle; without pins the vertices that
/// are farthest out keep the coordinate they are extreme in, and u and v are scaled in the end, each so that Σ A (|∇u|²
/// + |∇u|⁻²) is least. Guarantees: what Flattening promises; no triangle flipped, no overlap, else the chart falls
/// back. Convex border, uniform or mean-value weights and no other condition: valid on every disk, up to rounding.
/// Breaks down: charts beyond half a sphere, where conformal starts flip or shrink without bound; large `length` on
/// strongly curved charts, which have no map of constant gradient; uniform weights with a free border on uneven meshes.
/// Gauss-Seidel needs O(n) sweeps; it is there to be compared with. Cost: O(n^1.5) per round. Result independent of the
/// number of threads. Papers: B. Lévy, J.-L. Mallet, Non-distorted texture mapping for sheared triangulated meshes,
/// SIGGRAPH 1998; L. Liu et al., A local/global approach to mesh parameterization, 2008 (the rounds of lengths); M.
/// Floater, Mean value coordinates, 2003.
///
/// @param charts one number below charts.count for every triangle.
/// @throws InvalidInput for a mesh, chart set, pin, line or option that breaks these preconditions; for conformal
///         where it can't be kept; without fall_back also for a chart of the wrong topology, naming chart and triangle;
///         SolverFailure for one without a valid map.
LevyResult flatten_levy(const TriangleMesh& mesh, const ChartSet& charts, const LevyOptions& options = {});

}  // namespace papilla
