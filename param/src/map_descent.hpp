// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "border_guard.hpp"
#include "map_energy.hpp"
#include "papilla/core/deadline.hpp"
#include "papilla/core/trace.hpp"

namespace papilla::param_detail {

struct DescentOptions {
  int max_iterations = 100;
  int least_iterations = 0;  ///< For convergence: near a saddle, the first gains are small.
  double tolerance = 1e-6;   ///< Stop when the energy falls by less than this fraction in an iteration.
  double negligible = 0;     ///< Stop also when the energy is below this.
  Deadline deadline;
  bool allow_flips = false;   ///< Let triangles turn over; the energy must then be finite for such.
  bool reuse_factor = false;  ///< Factor again only when a step disappoints: for energies that are nearly quadratic.
  /// Far from the minimum, make the steps of Newton's method for the logarithm of the energy. These go the same way,
  /// and further: near a wall like 1/x² three times as far.
  bool of_logarithm = false;
  bool leave_when_blocked = false;  ///< Stop, as stalled, after a step that the barrier all but prevented.
  /// The start is rough: before a step did what it promised, nothing is given up, nor does one step that the barrier
  /// shortened count as convergence.
  bool from_far = false;
  bool foresee = false;  ///< Stop also when what full steps have still to gain is below the tolerance.
  /// Stop, as at the limit of iterations, when the energy will hardly come below this.
  double give_up_energy = std::numeric_limits<double>::infinity();
};

struct DescentResult {
  double energy = 0;  ///< Without the barrier's part.
  int iterations = 0;
  StopReason stop = StopReason::iteration_limit;
  Trace trace;  ///< error = energy; one sample at the start and after each iteration.
};

/// A map's triangles and the energy to be lowered. With a barrier, no state is taken in which the border meets itself.
/// `accept` may refuse states for reasons of its own; the descent ends where it does.
struct DescentProblem {
  std::span<const Triangle> triangles;
  const MapEnergy* energy = nullptr;
  const BorderBarrier* barrier = nullptr;
  std::function<bool(std::span<const Vec2>)> accept = {};
};

double total_energy(const DescentProblem& problem, std::span<const Vec2> uv);
std::vector<Vec2> energy_gradient(const DescentProblem& problem, std::span<const Vec2> uv);

/// The step along `direction` with which the first triangle turns over; infinity when none does.
double step_to_first_flip(std::span<const Triangle> triangles, std::span<const Vec2> uv,
                          std::span<const Vec2> direction);

/// Steepest descent with line search; each search begins at twice the step that the last one took.
DescentResult descend_gradient(const DescentProblem& problem, std::vector<Vec2>& uv, const DescentOptions& options);

/// Projected Newton (Gauss-Newton for energies whose `hessian` is that) with line search. Without a barrier one
/// symbolic factorization serves all iterations.
DescentResult descend(const DescentProblem& problem, std::vector<Vec2>& uv, const DescentOptions& options);

/// Rings around the origin that vertices lie on or between: vertex v moves in or out with (1 - share) of what ring
/// `inner` does and share of what the next one does.
struct RingScales {
  struct Place {
    Index inner = 0;
    double share = 0;
  };
  std::vector<Place> place;  ///< Per vertex.
  std::size_t rings = 0;
};

/// Projected Newton over the scales of rings alone: a full matrix as small as there are rings.
DescentResult descend_by_rings(const DescentProblem& problem, const RingScales& scales, std::vector<Vec2>& uv,
                               const DescentOptions& options);

}  // namespace papilla::param_detail
