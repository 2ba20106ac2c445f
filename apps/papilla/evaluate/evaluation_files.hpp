// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/pipeline/evaluate/evaluation.hpp"
#include "papilla/pipeline/evaluate/stability.hpp"
#include "result_folder.hpp"

namespace papilla::app {

/// The output folder of an evaluation: writes evaluate-KIND plus an ending and collects the names.
class EvaluationFolder {
 public:
  /// @throws IoError when `path` can't be made a folder.
  EvaluationFolder(const std::string& path, const std::string& kind);

  void write(const std::string& ending, const std::string& content);
  const std::vector<std::string>& files() const { return files_; }

 private:
  ResultFolder folder_;
  std::filesystem::path stem_;
  std::vector<std::string> files_;
};

/// A name as shown() makes it, as a field of a CSV line: quoted where RFC 4180 requires it.
std::string csv_field(const std::string& name);

/// method,solver,input,error_name,repeat,seconds,error: a line a sample. Repeat 0 is the curve of median times.
std::string runs_csv(const std::vector<EvaluationRun>& runs);

/// For people: every curve, and what is on each Pareto front.
std::string runs_summary(const std::vector<EvaluationRun>& runs, const std::vector<EvaluationGroup>& groups);

/// A picture of runs, as SVG.
struct EvaluationPicture {
  std::string title, svg;
};

/// Per group the error over run time with the front and every repeat, the last errors as bars, and where the runs have
/// them the shares of the surface. Empty without gnuplot.
std::vector<EvaluationPicture> runs_pictures(const std::vector<EvaluationGroup>& groups);

/// A self-contained page: all pictures and tables of the runs, method against input.
std::string runs_html(const std::string& kind, const std::vector<EvaluationPicture>& pictures,
                      const std::vector<EvaluationRun>& runs);

/// suite,method,input,outcome,error,residual,iterations,seconds,note: a line a cell.
std::string stability_csv(const std::vector<StabilitySuite>& suites);
/// A table a suite: inputs down, methods across, in every cell the outcome and the error; then all notes.
std::string stability_markdown(const std::vector<StabilitySuite>& suites);
/// The same tables as a self-contained page.
std::string stability_html(const std::vector<StabilitySuite>& suites);
/// How often each outcome occurs, a line a suite; then what breaks.
std::string stability_summary(const std::vector<StabilitySuite>& suites);

}  // namespace papilla::app
