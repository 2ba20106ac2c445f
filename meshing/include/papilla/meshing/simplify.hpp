// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "papilla/core/deadline.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/meshing/deviation.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Options of simplify().
struct SimplifyOptions {
  /// No point of the result is farther from the input than this, and none of the input from the result when
  /// `two_sided`; infinity: only `target_triangles` counts.
  double tolerance_mm = std::numeric_limits<double>::infinity();
  std::size_t target_triangles = 0;  ///< Stop at so many; 0: as few as the tolerance allows.
  bool two_sided = true;             ///< Also measure the input's points against the result.
  bool lock_border = false;  ///< Keep every border vertex; otherwise borders keep their course within the tolerance.
  double feature_angle_deg = 30;  ///< Edges with a larger angle between their normals stay edges; 180: none.
  bool keep_faces = true;         ///< The borders between TriangleMesh::face numbers stay, too.
  int passes = 2;          ///< Each further pass allows collapses of twice the error; 1 is fastest, 4 leaves least.
  Deadline deadline = {};  ///< Ends with what holds the tolerance by then; time to measure it is kept.
  ProgressCallback progress = {};  ///< Told the fraction done; may be empty.
};

struct SimplifyResult {
  TriangleMesh mesh;
  std::size_t triangles_before = 0;
  /// Measured between input and result, to 5 % or a tenth of the tolerance; without means.
  DeviationResult deviation;
  /// Run time against triangles kept / triangles before, of every mesh that held the tolerance.
  Trace trace;
  /// `converged`: the target is reached, or without one all passes are done; `iteration_limit`: the tolerance ended it
  /// before the target; `time_limit`: the deadline ended it.
  StopReason stop = StopReason::converged;
};

/// Decimation within a surface tolerance: half-edge collapses in the order of quadric error [Garland and Heckbert,
/// Surface simplification using quadric error metrics, SIGGRAPH 1997], *checked by measurement*: each pass collapses up
/// to an error, measures the distances (deviation.hpp), keeps the vertices near the places that are worst, and starts
/// again, until the tolerance holds everywhere. A pass that does not get there in five rounds is tried with less
/// error, then dropped. The next pass starts from the result with twice the error.
///
/// Vertices are never moved or made, so whatever they carry stays exact. Kept: borders, uv, uv1, cad_uv and colour
/// seams, material and face borders, features; they are thinned out along their course only. Normals: those of the
/// vertices that stay, and where a smooth fan has several, their mean by area. Non-manifold edges and their vertices
/// stay as they are. Triangles that repeat a position are dropped.
///
/// The collapses are own code, chosen by measurement on the office chair, a knurled CAD insert and a scanned head, with
/// tolerances of 1e-3 and 1e-4 of the diagonal, triangles left at equal measured deviation, features kept:
/// libmeshoptimizer 0.18 left 1.02 to 1.8 times as many with the same passes and checks (its quadrics are means, so a
/// collapse it counts as e lies up to 4 e off, and single precision, which drowns errors below 2e-4 of the extent; 0.35
/// us a triangle against 0.4 to 2.7 here, where measuring takes 20); CGAL 5.5 (Garland-Heckbert) left 0.85 to 1.27
/// times as many without keeping features, which it can do only by freezing their edges, moves vertices off their uv,
/// refuses non-manifold meshes, and took 2 to 10 us. Slivers are fine: planes of triangles lower than 1e-6 of the
/// diagonal don't count.
///
/// Good input: welded or weldable by exact positions (soups are joined here), repaired: double sheets are non-manifold.
/// Cost: 15 to 60 us of processor time a triangle with two passes, nearly all for measuring, which is parallel; about
/// 500 bytes a triangle. Deterministic, whatever the number of threads.
/// @param mesh With finite positions and indices in range.
/// @throws InvalidInput when the mesh breaks that or exceeds 1e15 mm, neither a tolerance nor a target is given, the
/// tolerance
///         is not positive, the angle is not in [0, 180], or passes are not in [1, 6]; Cancelled.
SimplifyResult simplify(const TriangleMesh& mesh, const SimplifyOptions& options);

/// What one tolerance of simplify() gives.
struct SimplifyStep {
  double tolerance_mm = 0;
  double seconds = 0;  ///< Wall time of simplify(), measuring included.
  std::size_t triangles = 0;
  double deviation_mm = 0, deviation_bound_mm = 0;  ///< Measured on the result.
  StopReason stop = StopReason::converged;
  Trace trace;  ///< SimplifyResult::trace.
};

/// Triangles and deviation over tolerance and run time of simplify(): each tolerance on the same input, in the order
/// given. Cost: that of simplify(), per tolerance. Deterministic but for the seconds.
/// @param options Its tolerance and target do not matter. @throws InvalidInput as simplify().
std::vector<SimplifyStep> simplify_ladder(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                          const SimplifyOptions& options = {});

/// A chain of ever coarser meshes, one per tolerance, each made from the one before and measured against the input, so
/// that every level holds its own tolerance. Levels share positions: each one's vertices are a subset of the
/// previous one's. A level may equal the one before when the tolerance allows nothing more.
/// @param tolerances_mm Positive and finite, ascending. @param options Its tolerance and target do not matter.
/// @throws InvalidInput as simplify(), and when the tolerances are not ascending.
std::vector<SimplifyResult> levels_of_detail(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                             const SimplifyOptions& options = {});

}  // namespace papilla
