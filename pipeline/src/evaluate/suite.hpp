// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "evaluate/budget.hpp"
#include "papilla/pipeline/evaluate/stability.hpp"

namespace papilla {

/// Progress and time of a suite.
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

/// Expected time on `many` triangles of work that took `seconds` on `few`: growing with n^1.25, as sparse
/// factorizations of surfaces do.
double expected_seconds(double seconds, std::size_t few, std::size_t many);

/// Runs work that sets outcome, numbers and note of a cell: measures its time, turns InvalidInput into `refuses` and
/// SolverFailure into `fails` with their message, and anything that is not finite into `breaks`; does not start when
/// the budget does not allow what the work is expected to take.
StabilityCell measured_cell(const StabilityRun& run, std::string method, std::string input,
                            const std::function<void(StabilityCell&)>& work, double expected_s = 0);

/// The size of inputs that all cost the same.
struct OneSize {
  template <class Input>
  std::size_t operator()(const Input&) const {
    return 1;
  }
};

/// Fills a suite: work(method, input, cell) for every input and every method. Both have a `name`.
/// For each input the methods that were fast on the first one run first, so that slow ones get the remaining time.
/// @param size_of an input's size: with the time on the first input it gives the expected time on the others.
template <class Inputs, class Methods, class Work, class SizeOf = OneSize>
void fill_suite(StabilitySuite& suite, const StabilityRun& run, const Inputs& inputs, const Methods& methods,
                Work&& work, SizeOf size_of = {}) {
  const std::size_t count = std::size(methods);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> first_input_s(count, 0);
  suite.cells.resize(std::size(inputs) * count);
  std::size_t done = 0;
  for (const auto& input : inputs) {
    for (const std::size_t m : order) {
      const auto& method = *std::next(std::begin(methods), static_cast<std::ptrdiff_t>(m));
      suite.cells[done * count + m] = measured_cell(
          run, method.name, input.name, [&](StabilityCell& cell) { work(method, input, cell); },
          expected_seconds(first_input_s[m], size_of(*std::begin(inputs)), size_of(input)));
    }
    if (done == 0) {
      for (std::size_t m = 0; m < count; ++m) first_input_s[m] = suite.cells[m].seconds;
      std::stable_sort(order.begin(), order.end(),
                       [&](std::size_t a, std::size_t b) { return first_input_s[a] < first_input_s[b]; });
    }
    ++done;
    report_progress(run.progress, "stability: " + suite.name,
                    static_cast<double>(done) / static_cast<double>(std::size(inputs)));
  }
}

}  // namespace papilla
