// SPDX-License-Identifier: MIT
#include "map_descent.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "chunks.hpp"
#include "dense_cholesky.hpp"
#include "sparse_cholesky.hpp"

namespace papilla::param_detail {
namespace {

/// Added to the diagonal once per triangle and corner: translations and rotations change no energy. The energy's own
/// entries are about 1.
constexpr double k_anchor = 1e-8;

/// Part of the way to the first flip that a step may go.
constexpr double k_before_flip = 0.9;

constexpr double k_armijo = 1e-4;

/// A full step that lowers the energy by this part of its slope or more (half of it is what a quadratic promises) is
/// reason to keep the factorization.
constexpr double k_good_step = 0.3;

/// A small gain means convergence only where the slope did not promise this many times as much.
constexpr double k_promise = 10;

/// A shorter step was stopped by the border where the barrier had no gradient yet; the next one has it. One such step
/// alone is no convergence.
constexpr double k_blocked_step = 0.1;

/// Of the gains of a full Newton step and the one before, while there is no other to go by; 0.04 to 0.3 were seen.
constexpr double k_first_ratio = 0.2;

/// What a full step gains of its slope, at most, where the next ones can be foreseen: half of it is what a quadratic
/// promises; more, and the energy bends less than the model, whose next steps are too short as well.
constexpr double k_most_gain = 0.6;

/// The energy falls by this many slopes of a Newton step in all, at most. A quadratic falls by half of one; what a
/// projected Hessian bends too much came to less than two.
constexpr double k_most_slopes = 4;

constexpr int k_halvings = 40;

/// A step that could be this much longer is tried so; by how much at once at most.
constexpr double k_longer = 1.5;
constexpr double k_longest = 4;

/// The parts of the energy that a step's slope promises between which the step is that for the logarithm: the slope of
/// x⁻² promises two thirds.
constexpr double k_far_promise = 0.3;
constexpr double k_most_promised = 0.75;

/// A lengthened step goes this part of its way at most: near a flip the next one would be short.
constexpr double k_room = 0.5;

/// Of negative curvature, this part is always left out: in all, the Hessian has to be positive.
constexpr double k_least_raised = 0.1;

/// One symbolic factorization serves while no vertex and edge of the border come near each other that were further
/// apart than this times their reach.
constexpr double k_watched_reach = 1.5;

/// Bisections between the longest step that is accepted and the shortest that is refused.
constexpr int k_refinements = 2;

double dot(std::span<const Vec2> a, std::span<const Vec2> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += papilla::dot(a[i], b[i]);
  return sum;
}

using Pairs = std::vector<BorderBarrier::Pair>;

Pairs near_pairs(const DescentProblem& problem, std::span<const Vec2> uv) {
  return problem.barrier ? problem.barrier->near_pairs(uv) : Pairs{};
}

double barrier_value(const DescentProblem& problem, const Pairs& pairs, std::span<const Vec2> uv) {
  double sum = 0;
  for (const auto& pair : pairs) sum += problem.barrier->value(pair, uv);
  return sum;
}

/// Factors for one state and solves H d = -g.
class NewtonStep {
 public:
  NewtonStep(const DescentProblem& problem, std::span<const Vec2> uv) : problem_(problem) {
    if (!problem.barrier) prepare(uv);
  }

  /// @param raised the part of each triangle's negative curvature that is left out; all of it where that is not enough.
  void factor(std::span<const Vec2> uv, const Pairs& pairs, double raised) {
    if (problem_.barrier && !(factor_ && watches(pairs))) prepare(uv);
    const std::size_t triangles = problem_.triangles.size();
    const auto bad_pivots = [&](double part) {
      return factor_->factor([&](std::size_t e, double* matrix) {
        if (e >= triangles) return problem_.barrier->hessian(watched_[e - triangles], uv, matrix);
        const auto [a, b, c] = problem_.triangles[e];
        problem_.energy->hessian(e, uv[a], uv[b], uv[c], part, matrix);
        for (std::size_t k = 0; k < 6; ++k) matrix[7 * k] += k_anchor;
      });
    };
    if (bad_pivots(raised) > 0 && raised < 1) bad_pivots(1);
  }

  std::vector<Vec2> direction(std::span<const Vec2> gradient) const {
    const std::size_t count = gradient.size();
    std::vector<double> right(2 * count);
    for (std::size_t v = 0; v < count; ++v) right[2 * v] = -gradient[v].x, right[2 * v + 1] = -gradient[v].y;
    factor_->solve(right);
    std::vector<Vec2> direction(count);
    for (std::size_t v = 0; v < count; ++v) direction[v] = {right[2 * v], right[2 * v + 1]};
    return direction;
  }

 private:
  static bool comes_before(const BorderBarrier::Pair& a, const BorderBarrier::Pair& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.from < b.from;
  }

  bool watches(const Pairs& pairs) const {
    return std::all_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
      return std::binary_search(watched_.begin(), watched_.end(), pair, comes_before);
    });
  }

  void prepare(std::span<const Vec2> uv) {
    if (problem_.barrier) watched_ = problem_.barrier->near_pairs(uv, k_watched_reach);
    std::sort(watched_.begin(), watched_.end(), comes_before);
    Elements elements = elements_of(problem_.triangles);
    for (const auto& pair : watched_) elements.add(std::array{pair.vertex, pair.from, pair.to});
    std::vector<Vec3> where(uv.size());
    for (std::size_t v = 0; v < uv.size(); ++v) where[v] = {uv[v].x, uv[v].y, 0};
    factor_.emplace(elements, where, 2);
  }

  const DescentProblem& problem_;
  Pairs watched_;  ///< What the factorization has room for, sorted; those that are too far apart add nothing.
  std::optional<SparseCholesky<double>> factor_;
};

/// The same for the scales of rings.
class RingStep {
 public:
  RingStep(const DescentProblem& problem, const RingScales& scales)
      : problem_(problem), scales_(scales), matrix_(scales.rings * scales.rings + k_dense_slack) {}

  std::vector<Vec2> direction(std::span<const Vec2> uv, std::span<const Vec2> gradient) {
    assemble(uv);
    const std::size_t rings = scales_.rings;
    std::vector<double> change(rings + k_dense_slack, 0);
    for (std::size_t v = 0; v < uv.size(); ++v) {
      const double out = -papilla::dot(uv[v], gradient[v]);
      for (const auto& [ring, share] : shares(v)) change[ring] += share * out;
    }
    factor_columns(matrix_.data(), rings, rings);
    solve_forward(matrix_.data(), rings, rings, change.data());
    solve_backward(matrix_.data(), rings, rings, change.data());
    std::vector<Vec2> direction(uv.size());
    for (std::size_t v = 0; v < uv.size(); ++v) {
      double scale = 0;
      for (const auto& [ring, share] : shares(v)) scale += share * change[ring];
      direction[v] = scale * uv[v];
    }
    return direction;
  }

 private:
  std::array<std::pair<std::size_t, double>, 2> shares(std::size_t v) const {
    const auto& [inner, share] = scales_.place[v];
    return {{{inner, 1 - share}, {inner + 1, share}}};
  }

  void assemble(std::span<const Vec2> uv) {
    const std::size_t rings = scales_.rings;
    std::fill(matrix_.begin(), matrix_.end(), 0);
    CornerHessian hessian;
    for (std::size_t t = 0; t < problem_.triangles.size(); ++t) {
      const Triangle& corners = problem_.triangles[t];
      problem_.energy->hessian(t, uv[corners[0]], uv[corners[1]], uv[corners[2]], 1, hessian.data());
      for (std::size_t q = 0; q < 3; ++q)
        for (std::size_t p = q; p < 3; ++p) {
          const Vec2 a = uv[corners[p]], b = uv[corners[q]];
          const double* block = hessian.data() + 6 * (2 * q) + 2 * p;
          const double upper = p == q ? block[1] : block[6];
          const double value = a.x * (block[0] * b.x + upper * b.y) + a.y * (block[1] * b.x + block[7] * b.y);
          for (const auto& [i, share_i] : shares(corners[p]))
            for (const auto& [j, share_j] : shares(corners[q])) {
              const double part = share_i * share_j * value;
              if (i >= j) matrix_[j * rings + i] += part;
              if (p != q && j >= i) matrix_[i * rings + j] += part;
            }
        }
    }
    for (std::size_t i = 0; i < rings; ++i) matrix_[i * rings + i] *= 1 + k_anchor;
  }

  const DescentProblem& problem_;
  const RingScales& scales_;
  std::vector<double> matrix_;
};

}  // namespace

double total_energy(const DescentProblem& problem, std::span<const Vec2> uv) {
  return sum_over(problem.triangles.size(), [&](std::size_t t) {
    const auto [a, b, c] = problem.triangles[t];
    return problem.energy->value(t, uv[a], uv[b], uv[c]);
  });
}

std::vector<Vec2> energy_gradient(const DescentProblem& problem, std::span<const Vec2> uv) {
  std::vector<CornerGradient> of_triangle(problem.triangles.size());
  for_chunks(of_triangle.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto [a, b, c] = problem.triangles[t];
      of_triangle[t] = problem.energy->gradient(t, uv[a], uv[b], uv[c]);
    }
  });
  std::vector<Vec2> gradient(uv.size());
  for (std::size_t t = 0; t < of_triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      Vec2& g = gradient[problem.triangles[t][k]];
      g = g + of_triangle[t][k];
    }
  return gradient;
}

double step_to_first_flip(std::span<const Triangle> triangles, std::span<const Vec2> uv,
                          std::span<const Vec2> direction) {
  return least_over(triangles.size(), [&](std::size_t i) {
    double step = std::numeric_limits<double>::infinity();
    const auto [p0, p1, p2] = triangles[i];
    const Vec2 m = uv[p1] - uv[p0], n = uv[p2] - uv[p0];
    const Vec2 dm = direction[p1] - direction[p0], dn = direction[p2] - direction[p0];
    // det(m + s dm, n + s dn) = c + b s + a s²
    const double a = cross(dm, dn), b = cross(m, dn) + cross(dm, n), c = cross(m, n);
    const double root = b * b - 4 * a * c;
    if (root < 0) return step;
    // Both roots without cancellation; the smaller positive one counts.
    const double q = -0.5 * (b + std::copysign(std::sqrt(root), b));
    if (a != 0 && q / a > 0) step = std::min(step, q / a);
    if (q != 0 && c / q > 0) step = std::min(step, c / q);
    return step;
  });
}

namespace {

struct Step {
  double length = 0;     ///< 0: none was found.
  bool refused = false;  ///< A longer one lowers the energy, but was not accepted.
};

/// The energy, barrier and all, along a direction from a state.
class LineSearch {
 public:
  /// @param slope derivative of the energy along the direction, negative.
  /// @param most the longest step that turns no triangle over.
  /// @param pairs near pairs of the border, of uv like the rest.
  LineSearch(const DescentProblem& problem, std::span<const Vec2> direction, double slope, double most,
             std::vector<Vec2>& uv, Pairs& pairs, double energy)
      : problem_(problem),
        direction_(direction),
        slope_(slope),
        most_(most),
        uv_(uv),
        pairs_(pairs),
        start_(energy + barrier_value(problem, pairs, uv)),
        trial_(uv.size()) {}

  /// Takes a step that satisfies Armijo's condition and that `accept` accepts.
  /// @param energy of uv on entry, of the new uv on return.
  Step run(double first_length, double& energy) {
    double length = std::min(first_length, most_);
    double shortening = 0;  // once a refused length is known: how much of it the next trial goes further or less far
    for (int i = 0, tries = k_halvings; i < tries; ++i) {
      const bool good = is_good(length, start_ + k_armijo * length * slope_);
      if (good) {
        take(length);
        if (!step_.refused) break;
        if (shortening == 0) shortening = 0.5 * length, tries = i + 1 + k_refinements;
        length += shortening;
      } else if (shortening == 0) {
        length *= 0.5;
        continue;
      } else {
        length -= shortening;
      }
      shortening *= 0.5;
    }
    if (step_.length > 0 && !problem_.accept) lengthen();
    if (step_.length > 0) std::swap(uv_, best_), std::swap(pairs_, best_pairs_), energy = energy_;
    return step_;
  }

 private:
  bool is_good(double length, double limit) {
    for (std::size_t v = 0; v < uv_.size(); ++v) trial_[v] = uv_[v] + length * direction_[v];
    if (problem_.barrier && !problem_.barrier->is_simple(trial_)) return false;
    trial_energy_ = total_energy(problem_, trial_);
    trial_pairs_ = near_pairs(problem_, trial_);
    trial_total_ = trial_energy_ + barrier_value(problem_, trial_pairs_, trial_);
    if (!(trial_total_ <= limit)) return false;
    const bool accepted = !problem_.accept || problem_.accept(trial_);
    step_.refused = step_.refused || !accepted;
    return accepted;
  }

  void take(double length) {
    std::swap(best_, trial_);
    trial_.resize(uv_.size());
    std::swap(best_pairs_, trial_pairs_);
    energy_ = trial_energy_;
    total_ = trial_total_;
    step_.length = length;
  }

  /// Further, to where a parabola through start, slope and the last value has its minimum, while that is much further:
  /// the projected Hessian bends more than an energy that is not convex.
  void lengthen() {
    for (;;) {
      const double length = step_.length, bend = (total_ - start_ - slope_ * length) / (length * length);
      double longer = std::min(k_room * most_, k_longest * length);
      if (bend > 0) longer = std::min(longer, -0.5 * slope_ / bend);
      if (!(longer > k_longer * length) || !is_good(longer, total_)) return;
      take(longer);
    }
  }

  const DescentProblem& problem_;
  std::span<const Vec2> direction_;
  double slope_, most_;
  std::vector<Vec2>& uv_;
  Pairs &pairs_, trial_pairs_, best_pairs_;
  double start_, energy_ = 0, total_ = 0;
  double trial_energy_ = 0, trial_total_ = 0;
  std::vector<Vec2> trial_, best_;
  Step step_;
};

/// What full Newton steps have still to gain after one that gained `gain`, as a geometric series by how the slopes went
/// down. @param slope_before 0: there was no step before.
double left_after(double gain, double slope, double slope_before) {
  const double ratio = slope_before < 0 ? slope / slope_before : k_first_ratio;
  return ratio < 1 ? gain * ratio / (1 - ratio) : std::numeric_limits<double>::infinity();
}

/// What the last step showed about the Hessian behind it.
struct Experience {
  bool good = false;  ///< The step did what was expected of it.
  double raised = 1;  ///< The part of the energy's negative curvature to be left out next time.
};

/// The iteration that all methods share: `direct(gradient, uv, pairs, experience)` says where to go.
template <class Direct>
DescentResult iterate(const DescentProblem& problem, std::vector<Vec2>& uv, const DescentOptions& options,
                      double growth, Direct direct) {
  const Stopwatch clock;
  DescentResult result;
  result.energy = total_energy(problem, uv);
  result.trace.push_back({clock.seconds(), result.energy});
  double step = 1, slope_before = 0;
  Experience experience;
  bool little_before = false, is_near = !options.from_far;
  Pairs pairs = near_pairs(problem, uv);
  while (result.iterations < options.max_iterations) {
    if (result.energy < options.negligible) {
      result.stop = StopReason::converged;
      break;
    }
    if (options.deadline.passed()) {
      result.stop = StopReason::time_limit;
      break;
    }
    std::vector<Vec2> gradient = energy_gradient(problem, uv);
    for (const auto& pair : pairs) {
      const auto g = problem.barrier->gradient(pair, uv);
      gradient[pair.vertex] = gradient[pair.vertex] + g[0];
      gradient[pair.from] = gradient[pair.from] + g[1];
      gradient[pair.to] = gradient[pair.to] + g[2];
    }
    const std::vector<Vec2> direction = direct(gradient, uv, pairs, experience);
    const double slope = dot(gradient, direction), before = result.energy;
    if (is_near && before + k_most_slopes * slope > options.give_up_energy) break;
    ++result.iterations;
    Step taken;
    if (slope < 0) {
      const double most = options.allow_flips ? std::numeric_limits<double>::infinity()
                                              : k_before_flip * step_to_first_flip(problem.triangles, uv, direction);
      // The logarithm's Hessian is H / E - g gᵀ / E².
      const double promised = std::min(-slope / before, k_most_promised);
      const double longer = options.of_logarithm && promised > k_far_promise ? step / (1 - promised) : step;
      const double first = std::max(step, std::min(longer, k_room * most));
      taken = LineSearch(problem, direction, slope, most, uv, pairs, result.energy).run(first, result.energy);
    }
    if (taken.length == 0) {
      // Near the minimum rounding hides how far the energy falls.
      result.stop =
          std::abs(slope) <= options.tolerance * before ? StopReason::converged : StopReason::line_search_stalled;
      break;
    }
    result.trace.push_back({clock.seconds(), result.energy});
    const double gain = before - result.energy, small = options.tolerance * result.energy;
    const bool little = std::abs(gain) <= small;
    const bool stands = little && (-slope <= k_promise * small ||
                                   (problem.barrier && (little_before || (is_near && taken.length >= k_blocked_step))));
    little_before = little;
    const bool as_foreseen =
        taken.length >= step && taken.length < k_longer * step && gain < -k_most_gain * taken.length * slope;
    is_near = is_near || as_foreseen;
    const bool was_last = options.foresee && as_foreseen && left_after(gain, slope, slope_before) <= small;
    if ((stands || was_last) && result.iterations >= options.least_iterations) {
      result.stop = StopReason::converged;
      break;
    }
    slope_before = slope;
    const bool blocked = problem.barrier && options.leave_when_blocked && taken.length < k_blocked_step * step;
    const bool stuck = !problem.barrier && !(gain > 0);  // what it gains is lost in rounding
    if (taken.refused || blocked || stuck) {
      result.stop = StopReason::line_search_stalled;
      break;
    }
    experience.good = taken.length >= step && gain > -k_good_step * step * slope;
    // Where the best step was n times that of the model, the energy bends 1/n as much: too much was left out.
    const bool too_stiff = taken.length >= step && -slope < k_far_promise * before;
    experience.raised = too_stiff ? std::max(k_least_raised, step / taken.length) : 1;
    step = growth > 1 ? growth * taken.length : 1;
  }
  return result;
}

}  // namespace

DescentResult descend_gradient(const DescentProblem& problem, std::vector<Vec2>& uv, const DescentOptions& options) {
  return iterate(problem, uv, options, 2,
                 [](const std::vector<Vec2>& gradient, std::span<const Vec2>, const Pairs&, const Experience&) {
                   std::vector<Vec2> direction(gradient);
                   for (Vec2& d : direction) d = -1.0 * d;
                   return direction;
                 });
}

DescentResult descend(const DescentProblem& problem, std::vector<Vec2>& uv, const DescentOptions& options) {
  NewtonStep newton(problem, uv);
  return iterate(
      problem, uv, options, 1,
      [&](const std::vector<Vec2>& gradient, std::span<const Vec2> at, const Pairs& pairs, const Experience& last) {
        if (!last.good || !options.reuse_factor) newton.factor(at, pairs, last.raised);
        return newton.direction(gradient);
      });
}

DescentResult descend_by_rings(const DescentProblem& problem, const RingScales& scales, std::vector<Vec2>& uv,
                               const DescentOptions& options) {
  RingStep newton(problem, scales);
  return iterate(problem, uv, options, 1,
                 [&](const std::vector<Vec2>& gradient, std::span<const Vec2> at, const Pairs&, const Experience&) {
                   return newton.direction(at, gradient);
                 });
}

}  // namespace papilla::param_detail
