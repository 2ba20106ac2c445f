// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/pipeline/evaluate/evaluation.hpp"

namespace papilla::app {

/// runs[] {method, solver, input, error_name, trace[] {seconds, error}, repeats[][] {seconds, error}, stop, valid,
/// notes, shares {error_name, edges[], shares[]}}.
Json runs_json(const std::vector<EvaluationRun>& runs);

/// method,solver,input,error_name,repeat,seconds,error: a line a sample, fields quoted as RFC 4180 has it. Repeat 0 is
/// the curve of median times.
std::string runs_csv(const std::vector<EvaluationRun>& runs);

/// A field of a CSV line, quoted where it must be.
std::string csv_field(const std::string& field);

/// A picture of runs, as SVG.
struct EvaluationPicture {
  std::string title, svg;
};

/// Runs with an input and an error in common, and who is on their Pareto front.
struct EvaluationGroup {
  std::string input, error_name;
  std::vector<const EvaluationRun*> runs;
  Trace front;
  std::vector<std::string> on_front;  ///< Names of the runs that reach it.
};

/// @param runs must outlive the groups.
std::vector<EvaluationGroup> runs_groups(const std::vector<EvaluationRun>& runs);

/// Per group the error over run time with the front and every repeat, the last errors as bars, and where the runs have
/// them the shares of the surface. Empty without gnuplot.
std::vector<EvaluationPicture> runs_pictures(const std::vector<EvaluationGroup>& groups);

/// One page that needs no other file: all pictures and tables of the runs, method against input.
std::string runs_html(const std::string& kind, const std::vector<EvaluationPicture>& pictures,
                      const std::vector<EvaluationRun>& runs);

}  // namespace papilla::app
