// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

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
  int passes = 2;  ///< Each further pass allows collapses of twice the error; 1 is fastest, 4 leaves least.
};

struct SimplifyResult {
  TriangleMesh mesh;
  std::size_t triangles_before = 0;
  /// Measured between input and result, to 5 % or a tenth of the tolerance; without means.
  DeviationResult deviation;
  /// Run time against triangles kept / triangles before, of every mesh that held the tolerance.
  Trace trace;
  /// `converged`: the target is reached, or without one all passes are done; `iteration_limit`: the tolerance ended it
  /// before the target.
  StopReason stop = StopReason::converged;
};

/// Decimation within a surface tolerance: half-edge collapses in the order of quadric error [Garland and Heckbert,
/// Surface simplification using quadric error metrics, 1997], done by libmeshoptimizer, and *checked by measurement*:
/// quadric errors are means over planes, so a collapse that they count as e may lie 4 e off. Each pass collapses up to
/// an error, measures the distances (deviation.hpp), keeps the vertices near the places that are worst, and starts
/// again, until the tolerance holds everywhere; if it does not after four rounds, the pass is dropped or, if it is the
/// first, tried with half the error. The next pass starts from the result with twice the error.
///
/// Vertices are never moved or made, so whatever they carry stays exact. Kept: borders, uv, uv1, cad_uv and colour
/// seams, material and face borders, features; they are thinned out along their course only. Normals: those of the
/// vertices that stay, and where a smooth fan has several, their mean by area. Non-manifold edges and vertices stay
/// as they are. Triangles that repeat a position are dropped.
/// Why libmeshoptimizer and not CGAL: measured on CAD meshes at equal measured deviation, CGAL 5.5's Garland-Heckbert
/// collapse took 8 to 10 us a triangle against 0.35, moves vertices off their uv, can keep seams and features only by
/// freezing each of their edges, and refuses non-manifold input; it reached between 10 % more and 45 % fewer
/// triangles than two passes here, without keeping features. Its Lindstrom-Turk cost was worse in both respects.
/// Good input: welded or weldable by exact positions (soups are joined here), repaired; slivers are fine.
/// Cost: about 0.4 us a triangle and round for collapses, 2 to 5 us for measuring; 3 to 8 rounds. Deterministic,
/// whatever the number of threads.
/// @param mesh With finite positions and indices in range.
/// @throws InvalidInput when the mesh breaks that or exceeds 1e15 mm, neither a tolerance nor a target is given, the
/// tolerance
///         is not positive, the angle is not in [0, 180], or passes are not in [1, 6].
SimplifyResult simplify(const TriangleMesh& mesh, const SimplifyOptions& options);

/// A part of a scene that shares a triangle budget.
struct BudgetPart {
  const TriangleMesh* mesh = nullptr;
  double importance = 1;      ///< > 0. A part of twice the importance gets half the error of the others.
  std::size_t instances = 1;  ///< How often it is drawn.
};

struct BudgetResult {
  std::vector<SimplifyResult> parts;  ///< In the order given.
  std::size_t triangles = 0;          ///< Drawn in the scene: sum over parts of triangles times instances.
  bool reached = false;               ///< `triangles` <= the budget. False when borders and seams allow no more.
};

/// Simplifies the parts of a scene until it draws at most `max_triangles`, all with the same collapse error times
/// importance; a scene that needs nothing comes back as it is. The deviations are measured and reported, not limited.
/// @param options Its tolerance, target and passes do not matter.
/// @throws InvalidInput as simplify(), naming the part; also for a missing mesh or an importance that is not positive.
BudgetResult simplify_to_budget(std::span<const BudgetPart> parts, std::size_t max_triangles,
                                const SimplifyOptions& options = {});

}  // namespace papilla
