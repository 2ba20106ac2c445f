// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ctime>

#include "json/json.hpp"
#include "papilla/pipeline/evaluate/evaluation.hpp"
#include "papilla/pipeline/evaluate/stability.hpp"

namespace papilla::app {

// Results of `evaluate` under the key names of docs/files.md.

/// kind, version, started, machine {cpu, cores, memory_mib, kernel}, options {files[], repeats, seconds, threads, seed,
/// chord_mm, angle_deg; of param: charts, normalize, methods[]}.
Json evaluation_json(const EvaluateOptions& options, std::time_t started, int threads, std::uint64_t seed);

/// runs[] {method, solver, input, error_name, trace[] {seconds, error}, repeats[][] {seconds, error}, stop, notes,
/// shares {error_name, edges[], shares[]}}.
Json runs_json(const std::vector<EvaluationRun>& runs);

/// pareto[] {input, error_name, front[]}.
Json pareto_json(const std::vector<EvaluationGroup>& groups);

/// suites[] {name, title, error_name, residual_name, cells[] {method, input, outcome, error, residual, iterations,
/// seconds, note}}; numbers without meaning are null.
Json stability_json(const std::vector<StabilitySuite>& suites);

}  // namespace papilla::app
