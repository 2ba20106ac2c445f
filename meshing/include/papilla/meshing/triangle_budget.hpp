// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "papilla/meshing/simplify.hpp"

namespace papilla {

/// A part of a scene that shares a triangle budget.
struct BudgetPart {
  const TriangleMesh* mesh = nullptr;
  double importance = 1;      ///< > 0. A part of twice the importance gets half the tolerance of the others.
  std::size_t instances = 1;  ///< How often it is drawn. 0: it counts for nothing, but keeps the same tolerance.
};

struct BudgetResult {
  std::vector<SimplifyResult> parts;  ///< In the order given.
  std::size_t triangles = 0;          ///< Drawn in the scene: sum over parts of triangles times instances.
  bool reached = false;               ///< `triangles` <= the budget. False when borders and seams allow no more.
  /// The common tolerance that every part holds, by measurement: part i lies within tolerance_mm / importance. 0 when
  /// the scene needed nothing; when the budget was not reached the largest distance measured.
  double tolerance_mm = 0;
  /// `time_limit`: the deadline ended the search. The fewest triangles by then, of a tolerance that is measured.
  StopReason stop = StopReason::converged;
  Trace trace;  ///< Run time against triangles drawn / budget, of every tolerance that was tried.
};

/// Simplifies the parts of a scene so that it draws at most `max_triangles`: simplify() with the smallest common
/// tolerance that does, found by regula falsi to 5 % or until at least 97 % of the budget are used. The number of
/// triangles falls with the tolerance but for small noise, so that a slightly smaller tolerance may do, too. A scene
/// that needs nothing comes back as it is. What cannot be reached within any tolerance is simplified as far as it pays:
/// within the first tolerance of those doubled that leaves at most 5 % more triangles than there must be. Cost: one
/// pass of collapses without measuring per doubling of the error from 1e-6 of the largest part, and 3 to 7 times
/// simplify(); parts are independent and parallel. At the deadline the search ends with what it has. Deterministic,
/// whatever the number of threads.
/// @param options Its tolerance and target do not matter.
/// @throws InvalidInput as simplify(), naming the part; also for a missing mesh, an importance that is not positive, or
/// a
///         budget of 0; Cancelled.
BudgetResult simplify_to_budget(std::span<const BudgetPart> parts, std::size_t max_triangles,
                                const SimplifyOptions& options = {});

}  // namespace papilla
