// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/evaluation_files.hpp"

#include <fmt/format.h>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/one_line.hpp"
#include "shown_format.hpp"

namespace papilla::app {
EvaluationFolder::EvaluationFolder(const std::string& path, const std::string& kind)
    : folder_(path), stem_(folder_.path() / ("evaluate-" + kind)) {}

void EvaluationFolder::write(const std::string& ending, const std::string& content) {
  const std::string file = stem_.string() + ending;
  write_atomically(file, content);
  files_.push_back(file);
}

std::string csv_field(const std::string& name) {
  const std::string field = shown(name);
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string out = "\"";
  for (const char c : field) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string runs_csv(const std::vector<EvaluationRun>& runs) {
  std::string csv = "method,solver,input,error_name,repeat,seconds,error\r\n";
  const auto add = [&](const EvaluationRun& run, const Trace& trace, std::size_t repeat) {
    for (const TraceSample& s : trace)
      csv += fmt::format("{},{},{},{},{},{},{}\r\n", csv_field(run.method), csv_field(run.solver), csv_field(run.input),
                         csv_field(run.error_name), repeat, s.seconds, s.error);
  };
  for (const EvaluationRun& run : runs) {
    add(run, run.trace, 0);
    for (std::size_t i = 0; i < run.repeats.size(); ++i) add(run, run.repeats[i], i + 1);
  }
  return csv;
}

std::string runs_summary(const std::vector<EvaluationRun>& runs, const std::vector<EvaluationGroup>& groups) {
  std::string text;
  for (const EvaluationRun& run : runs) {
    text += shown_format("{}, {}: {}{}\n", run.name(), run.input, run.error_name, run.valid ? "" : " (not valid)");
    for (const TraceSample& s : run.trace) text += fmt::format("  {:>10.4f} s  {:.6g}\n", s.seconds, s.error);
    if (run.trace.empty()) text += "  " + run.stop + "\n";
  }
  for (const EvaluationGroup& group : groups)
    text += shown_format("on the Pareto front of {}, {}: {}\n", group.input, group.error_name,
                         fmt::format("{}", fmt::join(group.on_front, ", ")));
  return text;
}

}  // namespace papilla::app
