// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/progress.hpp"

namespace papilla {

/// The outcome of a method on an input that was made to break it.
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

/// A method on an input. Numbers that have no meaning there are absent.
struct StabilityCell {
  std::string method, input;
  Outcome outcome = Outcome::holds;
  std::optional<double> error = {}, residual = {};  ///< StabilitySuite::error_name and residual_name.
  std::optional<int> iterations = {};               ///< Absent: a direct method.
  double seconds = 0;
  std::string note = {};
};

/// All methods of a kind on all inputs of a kind.
struct StabilitySuite {
  std::string name, title, error_name, residual_name;
  std::vector<StabilityCell> cells;  ///< One for every method and every input.
};

/// Time for all suites with some room to spare: a million triangles under every method take nearly all of it.
inline constexpr double k_stability_seconds = 3600;

/// Every method on extreme input: parameterization, meshing, fractal dimension, lattice, shape from shading, contact.
/// Deterministic except for times and for what is left out when `seconds` are spent.
std::vector<StabilitySuite> evaluate_stability(double seconds = k_stability_seconds,
                                               const ProgressCallback& progress = {});

}  // namespace papilla
