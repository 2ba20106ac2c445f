// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/evaluation_files.hpp"

#include <fmt/format.h>

#include <map>

#include "evaluate/pareto.hpp"

namespace papilla::app {
namespace {

Json trace_json(const Trace& trace) {
  Json json = Json::array();
  for (const TraceSample& s : trace) json.push_back({{"seconds", s.seconds}, {"error", s.error}});
  return json;
}

}  // namespace

std::string csv_field(const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string out = "\"";
  for (const char c : field) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

Json runs_json(const std::vector<EvaluationRun>& runs) {
  Json json = Json::array();
  for (const EvaluationRun& run : runs) {
    Json repeats = Json::array();
    for (const Trace& repeat : run.repeats) repeats.push_back(trace_json(repeat));
    Json entry = {{"method", run.method},
                  {"solver", run.solver},
                  {"input", run.input},
                  {"error_name", run.error_name},
                  {"trace", trace_json(run.trace)},
                  {"repeats", std::move(repeats)},
                  {"stop", run.stop},
                  {"notes", run.notes}};
    if (!run.shares.shares.empty())
      entry["shares"] = {
          {"error_name", run.shares.error_name}, {"edges", run.shares.edges}, {"shares", run.shares.shares}};
    json.push_back(std::move(entry));
  }
  return json;
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

std::vector<EvaluationGroup> runs_groups(const std::vector<EvaluationRun>& runs) {
  std::vector<EvaluationGroup> groups;
  std::map<std::pair<std::string, std::string>, std::size_t> place;
  for (const EvaluationRun& run : runs) {
    const auto [at, added] = place.try_emplace({run.input, run.error_name}, groups.size());
    if (added) groups.push_back({run.input, run.error_name, {}, {}, {}});
    groups[at->second].runs.push_back(&run);
  }
  for (EvaluationGroup& group : groups) {
    std::vector<Trace> traces;
    for (const EvaluationRun* run : group.runs)
      if (run->valid) traces.push_back(run->trace);
    group.front = pareto_front(traces);
    for (const EvaluationRun* run : group.runs)
      if (run->valid && reaches_front(run->trace, group.front)) group.on_front.push_back(run->name());
  }
  return groups;
}

}  // namespace papilla::app
