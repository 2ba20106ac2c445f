// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "json/json.hpp"
#include "papilla/pipeline/evaluate/evaluation.hpp"

namespace papilla::app {

// The table of `evaluate param`: a row per input, method and solver, each at its default options. It holds no times:
// the same command gives the same bytes.

/// A line of names, then a line a row. Numbers that a row does not have are empty.
std::string param_csv(const std::vector<EvaluationRun>& runs, const ParamComparison& comparison);

/// The same rows as objects; numbers that a row does not have are null.
Json param_rows_json(const std::vector<EvaluationRun>& runs, const ParamComparison& comparison);

/// The columns that a paper shows, as a `table*` for the LaTeX package booktabs.
/// @param command What was run; it stands in a comment, with the version.
std::string param_latex(const std::vector<EvaluationRun>& runs, const ParamComparison& comparison,
                        const std::string& command);

/// A text for LaTeX's text mode: special characters escaped, line breaks and control characters shown.
std::string latex_text(const std::string& text);

}  // namespace papilla::app
