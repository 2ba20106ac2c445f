// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "evaluate/suite.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

/// In the order of the tables, the slowest first.
constexpr std::array k_suites = {param_stability,   mesh_stability,    dimension_stability,
                                 lattice_stability, shading_stability, contact_stability};

}  // namespace

std::string_view to_string(Outcome outcome) noexcept {
  switch (outcome) {
    case Outcome::holds: return "holds";
    case Outcome::falls_back: return "falls back";
    case Outcome::refuses: return "refuses";
    case Outcome::fails: return "fails";
    case Outcome::breaks: return "breaks";
    case Outcome::not_run: return "not run";
  }
  return "";
}

double expected_seconds(double seconds, std::size_t few, std::size_t many) {
  return seconds * std::pow(static_cast<double>(many) / static_cast<double>(few), 1.25);
}

StabilityCell measured_cell(const StabilityRun& run, std::string method, std::string input,
                            const std::function<void(StabilityCell&)>& work, double expected_s) {
  StabilityCell cell{std::move(method), std::move(input)};
  if (run.budget.spent() || !run.budget.allows(expected_s)) {
    cell.outcome = Outcome::not_run;
    cell.note = fmt::format("expected to take {:.0f} s of {:.0f} s left", expected_s, run.budget.left());
    return cell;
  }
  const Stopwatch clock;
  try {
    work(cell);
    const auto finite = [](const std::optional<double>& value) { return !value || std::isfinite(*value); };
    if (!finite(cell.error) || !finite(cell.residual)) {
      cell.outcome = Outcome::breaks;
      cell.note += "; a number that is not finite";
    }
  } catch (const InvalidInput& error) {
    cell.outcome = Outcome::refuses;
    cell.note = error.what();
  } catch (const SolverFailure& error) {
    cell.outcome = Outcome::fails;
    cell.note = error.what();
  }
  cell.seconds = clock.seconds();
  return cell;
}

std::vector<StabilitySuite> evaluate_stability(double seconds, const ProgressCallback& progress) {
  const Budget budget(seconds);
  std::vector<StabilitySuite> suites;
  for (std::size_t left = k_suites.size(); left > 0; --left)  // The slowest runs last, with all the time left over.
    suites.push_back(k_suites[left - 1]({progress, budget.share(left)}));
  std::reverse(suites.begin(), suites.end());
  return suites;
}

}  // namespace papilla
