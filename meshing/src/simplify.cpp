// SPDX-License-Identifier: MIT
#include "papilla/meshing/simplify.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <string>

#include "papilla/core/error.hpp"
#include "simplifier.hpp"

namespace papilla {
namespace {

using detail::Simplifier;

/// Parts of a scene on their way to a budget.
class BudgetRun {
 public:
  BudgetRun(std::span<const BudgetPart> parts, const SimplifyOptions& options) : parts_(parts), states_(parts.size()) {
    oneapi::tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
      const std::string name = "simplify_to_budget: parts[" + std::to_string(i) + "]";
      if (parts[i].mesh == nullptr) throw InvalidInput(name + " has no mesh");
      if (!(parts[i].importance > 0)) throw InvalidInput(name + ": the importance is not positive");
      states_[i].simplifier = std::make_unique<Simplifier>(*parts[i].mesh, options, name);
      states_[i].indices = states_[i].simplifier->all();
    });
  }

  BudgetResult run(std::size_t budget) {
    double largest = 0;
    for (const State& s : states_) largest = std::max(largest, s.simplifier->diagonal());
    constexpr double k_first_error = 1e-6, k_last_error = 4;  // of the largest part
    for (double error = k_first_error * largest; drawn() > budget && error < k_last_error * largest; error *= 2)
      coarsen(error, budget);
    BudgetResult result;
    result.triangles = drawn();
    result.reached = result.triangles <= budget;
    result.parts.resize(parts_.size());
    oneapi::tbb::parallel_for(std::size_t{0}, parts_.size(), [&](std::size_t i) {
      result.parts[i] = states_[i].simplifier->result(states_[i].indices, std::numeric_limits<double>::infinity());
      if (!result.reached) result.parts[i].stop = StopReason::iteration_limit;
    });
    return result;
  }

 private:
  struct State {
    std::unique_ptr<Simplifier> simplifier;
    std::vector<Index> indices, next;
  };

  std::size_t drawn() const {
    return drawn([](const State& s) { return s.indices.size(); });
  }

  template <class Size>
  std::size_t drawn(const Size& size) const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) sum += parts_[i].instances * (size(states_[i]) / 3);
    return sum;
  }

  /// Takes the step to `error`, or, when that would go below the budget, the fraction of it that is needed.
  void coarsen(double error, std::size_t budget) {
    each([&](std::size_t i, State& s) { s.next = s.simplifier->collapse(s.indices, error / parts_[i].importance, 0); });
    const std::size_t before = drawn(), after = drawn([](const State&s) { return s.next.size(); });
    if (after < budget) {
      const double fraction = static_cast<double>(before - budget) / static_cast<double>(before - after);
      each([&](std::size_t i, State& s) {
        const auto step = std::ceil(fraction * static_cast<double>((s.indices.size() - s.next.size()) / 3));
        const std::size_t target = s.indices.size() / 3 - static_cast<std::size_t>(step);
        s.next = s.simplifier->collapse(s.indices, error / parts_[i].importance, target);
      });
    }
    for (State& s : states_) s.indices = std::move(s.next);
  }

  template <class Body>
  void each(const Body& body) {
    oneapi::tbb::parallel_for(std::size_t{0}, states_.size(), [&](std::size_t i) { body(i, states_[i]); });
  }

  std::span<const BudgetPart> parts_;
  std::vector<State> states_;
};

}  // namespace

SimplifyResult simplify(const TriangleMesh& mesh, const SimplifyOptions& options) {
  const Stopwatch clock;
  if (!std::isfinite(options.tolerance_mm) && options.target_triangles == 0)
    throw InvalidInput("simplify: neither a tolerance nor a target is given");
  const Simplifier simplifier(mesh, options, "simplify");
  Trace trace;
  std::vector<Index> indices;
  if (std::isfinite(options.tolerance_mm)) {
    indices = simplifier.within(simplifier.all(), options.tolerance_mm, options.target_triangles, clock, trace);
  } else {
    constexpr double k_unlimited = 10;  // times the diagonal
    indices = simplifier.collapse(simplifier.all(), k_unlimited * simplifier.diagonal(), options.target_triangles);
  }
  SimplifyResult result = simplifier.result(indices, options.tolerance_mm);
  result.trace = std::move(trace);
  if (options.target_triangles > 0 && result.mesh.triangles.size() > options.target_triangles)
    result.stop = StopReason::iteration_limit;
  return result;
}

BudgetResult simplify_to_budget(std::span<const BudgetPart> parts, std::size_t max_triangles,
                                const SimplifyOptions& options) {
  return BudgetRun(parts, options).run(max_triangles);
}

}  // namespace papilla
