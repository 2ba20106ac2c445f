// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/read_options.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/pipeline/unwrap_method.hpp"

namespace papilla {

/// How the surface's area is distributed over a kind of error: share i lies in [edges[i], edges[i + 1]).
struct ErrorShares {
  std::string error_name;
  std::vector<double> edges, shares;
};

/// What a method made of an input at its default options: a row of the table of `param`.
struct EvaluatedMap {
  std::string input;  ///< File, and the part of it.
  std::size_t triangles = 0;
  std::uint32_t given_charts = 0;  ///< All methods get the same.
  std::uint32_t charts = 0;        ///< Of the map: projections and `natural` make their own.
  std::size_t replaced = 0;        ///< Charts that the method has no valid map of; they got another one.
  DistortionReport distortion;     ///< Without per_triangle.
  bool valid = false;              ///< No triangle flipped or without area, no chart lying over itself.
  std::string failure;             ///< Why there is no map; empty when there is one.
};

/// One curve of error over run time.
struct EvaluationRun {
  std::string method;               ///< The name on the command line.
  std::string solver;               ///< The variant.
  std::string input;                ///< File, and the part of it.
  std::string error_name;           ///< With its unit.
  Trace trace;                      ///< Of several repeats: their median times.
  std::string stop;                 ///< to_string(StopReason), or why there is no trace.
  std::string notes = {};           ///< What the trace does not contain, for people.
  bool valid = true;                ///< False: the result can't be used; the run is drawn, but it is on no front.
  ErrorShares shares = {};          ///< Of the last sample; may be empty.
  std::vector<Trace> repeats = {};  ///< Every repeat as measured, the first one included.
  std::optional<EvaluatedMap> map = std::nullopt;  ///< Of `param`, once per method, solver and input.

  std::string name() const { return solver.empty() ? method : method + " (" + solver + ")"; }
};

/// One file for one kind of evaluation.
struct EvaluationInput;

/// A kind of evaluation: its name on the command line, one line of help, and what it runs for one file.
struct EvaluationKind {
  std::string_view name;
  std::string_view summary;
  std::vector<EvaluationRun> (*run)(const EvaluationInput&);
};

/// All kinds, in the order of the help.
std::span<const EvaluationKind> evaluation_kinds();

/// What `param` compares.
struct ParamComparison {
  std::vector<UnwrapMethod> methods = {};  ///< Empty: all.
  /// automatic: one chart, the whole part where it can be one. Else all charts that given_charts() makes of the part.
  ChartSource charts = ChartSource::automatic;
  UvNormalization normalize = UvNormalization::scene;

  bool has(UnwrapMethod method) const {
    return methods.empty() || std::find(methods.begin(), methods.end(), method) != methods.end();
  }
};

/// Options of evaluate().
struct EvaluateOptions {
  std::string kind;                ///< EvaluationKind::name.
  std::vector<std::string> files;  ///< Empty: the built-in inputs of the kind.
  ReadOptions read;
  int repeats = 3;             ///< Measure up to this often while the time allows it.
  double seconds = 60;         ///< Time for each file. No work is begun that is not expected to end in time.
  ParamComparison param = {};  ///< Of the kind `param`; the others ignore it.
};

struct Evaluation {
  std::vector<std::string> files;  ///< Those evaluated; built-in inputs are removed afterwards.
  std::vector<EvaluationRun> runs;
};

/// Runs a kind of evaluation on every file. Deterministic except for times and for what is left out for lack of time,
/// which has a run without trace that says so.
/// @throws InvalidInput for an unknown kind; whatever reading a file throws.
Evaluation evaluate(const EvaluateOptions& options, const ProgressCallback& progress = {});

/// Samples that no other one beats in both time and error, from the fastest to the slowest. Errors that are not finite
/// are left out.
Trace pareto_front(const std::vector<Trace>& traces);

/// Whether a sample of the trace is on the front.
bool reaches_front(const Trace& trace, const Trace& front);

/// Runs with the same input and the same error, and their Pareto front.
struct EvaluationGroup {
  std::string input, error_name;
  std::vector<const EvaluationRun*> runs;
  Trace front;                        ///< Of the valid runs.
  std::vector<std::string> on_front;  ///< Names of the valid runs that reach it.
};

/// @param runs must outlive the groups.
std::vector<EvaluationGroup> group_runs(const std::vector<EvaluationRun>& runs);

}  // namespace papilla
