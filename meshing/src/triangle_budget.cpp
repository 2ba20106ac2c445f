// SPDX-License-Identifier: MIT
#include "papilla/meshing/triangle_budget.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "papilla/core/error.hpp"
#include "simplifier.hpp"

namespace papilla {
namespace {

using detail::Simplifier;

constexpr double k_first_error = 1e-6, k_last_error = 4;  ///< Of the largest part's diagonal.
constexpr double k_used = 0.97;                           ///< This share of the budget is good enough.
constexpr double k_narrow = 1.05;                         ///< So is a tolerance known to this factor.
constexpr int k_most_trials = 12;
/// A budget out of reach: so many times the fewest triangles are as good as these, for less deviation.
constexpr double k_pays = 1.05;

using IndexLists = std::vector<std::vector<Index>>;

/// Parts of a scene on their way to a budget.
class BudgetRun {
 public:
  BudgetRun(std::span<const BudgetPart> parts, std::size_t budget, const SimplifyOptions& options)
      : parts_(parts), budget_(budget), progress_(options.progress), simplifiers_(parts.size()) {
    SimplifyOptions in_time = options;
    std::size_t triangles = 0;
    for (const BudgetPart& part : parts) triangles += part.mesh == nullptr ? 0 : part.mesh->triangles.size();
    in_time.deadline = options.deadline.earlier_by(detail::seconds_to_measure(triangles));
    each([&](std::size_t i) {
      const std::string name = "simplify_to_budget: parts[" + std::to_string(i) + "]";
      if (parts[i].mesh == nullptr) throw InvalidInput(name + " has no mesh");
      if (!(parts[i].importance > 0)) throw InvalidInput(name + ": the importance is not positive");
      simplifiers_[i] = std::make_unique<Simplifier>(*parts[i].mesh, in_time, name);
    });
  }

  BudgetResult run() {
    BudgetResult result;
    IndexLists indices = whole();
    note(indices, result.trace);
    if (drawn(indices) > budget_) {
      const double error = find_error(indices);
      if (drawn(indices) <= budget_) {
        result.tolerance_mm = find_tolerance(error, indices, result.trace);
      } else if (!is_out_of_time()) {
        result.tolerance_mm = error;
        indices = within(error);
        note(indices, result.trace);
      }
    }
    result.triangles = drawn(indices);
    result.reached = result.triangles <= budget_;
    measure(indices, result);
    if (is_out_of_time()) {
      result.stop = StopReason::time_limit;
      for (SimplifyResult& part : result.parts) part.stop = result.stop;
    }
    return result;
  }

 private:
  IndexLists whole() const {
    IndexLists indices;
    for (const auto& simplifier : simplifiers_) indices.push_back(simplifier->all());
    return indices;
  }

  std::size_t drawn(const IndexLists& indices) const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) sum += parts_[i].instances * (indices[i].size() / 3);
    return sum;
  }

  bool is_out_of_time() const {
    return std::any_of(simplifiers_.begin(), simplifiers_.end(),
                       [](const auto& simplifier) { return simplifier->is_out_of_time(); });
  }

  void note(const IndexLists& indices, Trace& trace) const {
    trace.push_back({clock_.seconds(), static_cast<double>(drawn(indices)) / static_cast<double>(budget_)});
  }

  /// A tolerance that was tried, with what it drew.
  struct Trial {
    double tolerance_mm = 0;
    std::size_t triangles = 0;
  };

  /// The first error of a doubling ladder at which unmeasured collapses meet the budget. Where none does, the first one
  /// that leaves hardly more than the last. Leaves the last result in `indices`.
  double find_error(IndexLists& indices) const {
    double largest = 0;
    for (const auto& simplifier : simplifiers_) largest = std::max(largest, simplifier->diagonal());
    std::vector<Trial> ladder;
    for (double error = k_first_error * largest;
         drawn(indices) > budget_ && error < k_last_error * largest && !is_out_of_time(); error *= 2) {
      each([&](std::size_t i) { indices[i] = simplifiers_[i]->collapse(indices[i], error / parts_[i].importance, 0); });
      ladder.push_back({error, drawn(indices)});
      report_progress(progress_, "simplify", come_to(1));
      ++steps_;
    }
    if (ladder.empty() || ladder.back().triangles <= budget_) return ladder.empty() ? 0 : ladder.back().tolerance_mm;
    const double hardly_more = k_pays * static_cast<double>(ladder.back().triangles);
    return std::find_if(ladder.begin(), ladder.end(),
                        [&](const Trial& t) { return static_cast<double>(t.triangles) <= hardly_more; })
        ->tolerance_mm;
  }

  /// The share of the search that is done with a fraction of this step: nobody knows how many it takes, so that each
  /// goes some way towards its end.
  double come_to(double fraction) const {
    constexpr double k_left = 0.9;
    return 1 - std::pow(k_left, steps_ + fraction);
  }

  IndexLists within(double tolerance_mm) const {
    IndexLists result(parts_.size());
    double triangles = 0;
    for (const auto& simplifier : simplifiers_) triangles += static_cast<double>(simplifier->all().size() / 3);
    SharedProgress done(
        [this](const Progress& p) {
          return !progress_ || progress_({p.stage, come_to(p.fraction)});
        },
        "simplify", triangles);
    each([&](std::size_t i) {
      Trace trace;
      const Simplifier& simplifier = *simplifiers_[i];
      WorkProgress work(done, static_cast<double>(simplifier.all().size() / 3));
      result[i] =
          simplifier.within(simplifier.all(), tolerance_mm / parts_[i].importance, 0, clock_, trace, work.callback());
      work.reach(1);
    });
    ++steps_;
    return result;
  }

  /// Between two trials: where a power law through both meets a count just below the budget, but not too near to
  /// either.
  double next_tolerance(const Trial& low, const Trial& high) const {
    constexpr double k_least_step = 0.1;
    const double wanted = 0.5 * (1 + k_used) * static_cast<double>(budget_);
    const auto logarithm = [](std::size_t n) { return std::log(std::max(1.0, static_cast<double>(n))); };
    const double fall = logarithm(low.triangles) - logarithm(high.triangles);
    const double share = fall > 0 ? (logarithm(low.triangles) - std::log(std::max(1.0, wanted))) / fall : 0.5;
    return low.tolerance_mm *
           std::pow(high.tolerance_mm / low.tolerance_mm, std::clamp(share, k_least_step, 1 - k_least_step));
  }

  /// Looks between a tolerance that is too small and one that is not, both held by measurement. `error` is a guess that
  /// is right to a factor of about two. Leaves the best result in `indices`, which meets the budget unmeasured.
  double find_tolerance(double error, IndexLists& indices, Trace& trace) const {
    Trial low, high;
    double tolerance = error;
    for (int trial = 0; trial < k_most_trials && !is_out_of_time(); ++trial) {
      IndexLists tried = within(tolerance);
      note(tried, trace);
      const std::size_t count = drawn(tried);
      (count <= budget_ ? high : low) = {tolerance, count};
      if (count <= budget_) indices = std::move(tried);
      const bool is_used = count <= budget_ && static_cast<double>(count) >= k_used * static_cast<double>(budget_);
      if (is_used ||
          (low.tolerance_mm > 0 && high.tolerance_mm > 0 && high.tolerance_mm <= k_narrow * low.tolerance_mm))
        break;
      if (low.tolerance_mm > 0 && high.tolerance_mm > 0)
        tolerance = next_tolerance(low, high);
      else
        tolerance *= high.tolerance_mm > 0 ? 0.5 : 2;
    }
    return high.tolerance_mm;
  }

  void measure(const IndexLists& indices, BudgetResult& result) const {
    const double limit = result.tolerance_mm > 0 ? result.tolerance_mm : std::numeric_limits<double>::infinity();
    result.parts.resize(parts_.size());
    each([&](std::size_t i) {
      result.parts[i] = simplifiers_[i]->result(indices[i], limit / parts_[i].importance);
      if (!result.reached) result.parts[i].stop = StopReason::iteration_limit;
    });
    if (result.tolerance_mm > 0 && result.reached) return;
    result.tolerance_mm = 0;  // Out of reach: what is held, not what was allowed.
    for (std::size_t i = 0; i < parts_.size(); ++i)
      result.tolerance_mm = std::max(result.tolerance_mm, parts_[i].importance * result.parts[i].deviation.bound());
  }

  template <class Body>
  void each(const Body& body) const {
    oneapi::tbb::parallel_for(std::size_t{0}, parts_.size(), body);
  }

  std::span<const BudgetPart> parts_;
  std::size_t budget_;
  ProgressCallback progress_;
  mutable int steps_ = 0;  ///< Of the search.
  std::vector<std::unique_ptr<Simplifier>> simplifiers_;
  Stopwatch clock_;
};

}  // namespace

BudgetResult simplify_to_budget(std::span<const BudgetPart> parts, std::size_t max_triangles,
                                const SimplifyOptions& options) {
  if (max_triangles == 0) throw InvalidInput("simplify_to_budget: the budget is 0");
  return BudgetRun(parts, max_triangles, options).run();
}

}  // namespace papilla
