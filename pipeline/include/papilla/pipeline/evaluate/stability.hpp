// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/pipeline/evaluate/budget.hpp"
#include "papilla/core/progress.hpp"

namespace papilla {

/// What became of a method on an input that was made to break it.
enum class Outcome {
  holds,       ///< A valid result by the method itself.
  falls_back,  ///< A valid result by another method, named in the note.
  refuses,     ///< A clear error: the input is not what the method takes.
  fails,       ///< A clear error: the input is, but there is no result.
  breaks,      ///< A result that can't be used.
  not_run,     ///< The time was spent.
};

/// The outcome as reports print it, for example "falls back".
std::string_view to_string(Outcome outcome) noexcept;

/// A method on an input. Numbers that have no meaning there are not given.
struct StabilityCell {
  std::string method, input;
  Outcome outcome = Outcome::holds;
  std::optional<double> error = {}, residual = {};  ///< What they are says the suite.
  std::optional<int> iterations = {};               ///< Not given: direct.
  double seconds = 0;
  std::string note = {};
};

/// All methods of a kind on all inputs of a kind.
struct StabilitySuite {
  std::string name, title, error_name, residual_name;
  std::vector<StabilityCell> cells;  ///< Of every method and every input one.
};

/// What the suites share while they run.
struct StabilityRun {
  ProgressCallback progress;
  Budget budget;
};

StabilitySuite param_stability(const StabilityRun& run);
StabilitySuite mesh_stability(const StabilityRun& run);
StabilitySuite dimension_stability(const StabilityRun& run);
StabilitySuite lattice_stability(const StabilityRun& run);
StabilitySuite shading_stability(const StabilityRun& run);
StabilitySuite contact_stability(const StabilityRun& run);

/// What work that took `seconds` on `few` triangles is expected to take on `many`: growing with n^1.25, as sparse
/// factorizations of surfaces do.
double expected_seconds(double seconds, std::size_t few, std::size_t many);

/// Fills a cell by work that sets outcome, numbers and note: takes the time, turns InvalidInput into `refuses` and
/// SolverFailure into `fails` with their message, and anything that is not finite into `breaks`; does not start when
/// the budget does not allow what the work is expected to take.
StabilityCell measured_cell(const StabilityRun& run, std::string method, std::string input,
                            const std::function<void(StabilityCell&)>& work, double expected_s = 0);

/// For inputs that all cost alike.
struct OneSize {
  template <class Input>
  std::size_t operator()(const Input&) const {
    return 1;
  }
};

/// Fills a suite: work(method, input, cell) for every input and every method. Both have a `name`.
/// For each input the methods that were quick on the first one come first, so that the dear ones get what is left.
/// @param size_of of an input: what a method took on the first one tells what it is expected to take on the others.
template <class Inputs, class Methods, class Work, class SizeOf = OneSize>
void fill_suite(StabilitySuite& suite, const StabilityRun& run, const Inputs& inputs, const Methods& methods,
                Work&& work, SizeOf size_of = {}) {
  const std::size_t count = std::size(methods);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> on_first_s(count, 0);
  suite.cells.resize(std::size(inputs) * count);
  std::size_t done = 0;
  for (const auto& input : inputs) {
    for (const std::size_t m : order) {
      const auto& method = *std::next(std::begin(methods), static_cast<std::ptrdiff_t>(m));
      suite.cells[done * count + m] = measured_cell(
          run, method.name, input.name, [&](StabilityCell& cell) { work(method, input, cell); },
          expected_seconds(on_first_s[m], size_of(*std::begin(inputs)), size_of(input)));
    }
    if (done == 0) {
      for (std::size_t m = 0; m < count; ++m) on_first_s[m] = suite.cells[m].seconds;
      std::stable_sort(order.begin(), order.end(),
                       [&](std::size_t a, std::size_t b) { return on_first_s[a] < on_first_s[b]; });
    }
    ++done;
    report_progress(run.progress, "stability: " + suite.name,
                    static_cast<double>(done) / static_cast<double>(std::size(inputs)));
  }
}

}  // namespace papilla
