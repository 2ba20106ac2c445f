// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/pipeline/evaluate/stability.hpp"
#include "verb.hpp"

namespace papilla::app {

using StabilityTables = std::vector<StabilitySuite>;

/// What all suites need with some room to spare: a million triangles under every method take nearly all of it.
inline constexpr double k_stability_seconds = 3600;

/// All suites. Deterministic but for times and what the budget leaves out.
StabilityTables run_stability_suites(const ProgressCallback& progress, const Budget& budget);

/// suites[] {name, title, error_name, residual_name, cells[] {method, input, outcome, error, residual, iterations,
/// seconds, note}}; numbers without meaning are null.
Json stability_json(const StabilityTables& tables);
/// suite,method,input,outcome,error,residual,iterations,seconds,note: a line a cell.
std::string stability_csv(const StabilityTables& tables);
/// A table a suite: inputs down, methods across, in every cell the outcome and the error; then all notes.
std::string stability_markdown(const StabilityTables& tables);
/// The same as a page that needs no other file.
std::string stability_html(const StabilityTables& tables);
/// How often each outcome came, a line a suite.
std::string stability_summary(const StabilityTables& tables);

}  // namespace papilla::app
