// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/evaluation_json.hpp"

#include <fmt/chrono.h>

#include "json/scene_json.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/machine.hpp"
#include "papilla/pipeline/measure_scene.hpp"

namespace papilla::app {

Json evaluation_json(const EvaluateOptions& options, std::time_t started, int threads, std::uint64_t seed) {
  const Machine machine = this_machine();
  Json json = {{"kind", options.kind},
               {"version", version()},
               {"started", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(started))},
               {"machine",
                {{"cpu", machine.cpu},
                 {"cores", machine.cores},
                 {"memory_mib", machine.memory_mib},
                 {"kernel", machine.kernel}}},
               {"options",
                {{"files", options.files},
                 {"repeats", options.repeats},
                 {"seconds", options.seconds},
                 {"threads", threads},
                 {"seed", seed},
                 {"chord_mm", options.read.chord_mm},
                 {"angle_deg", options.read.angle_deg}}}};
  if (options.kind == "param") {
    json["options"]["charts"] = chart_source_name(options.param.charts);
    json["options"]["normalize"] = uv_normalization_name(options.param.normalize);
    json["options"]["methods"] = Json::array();
    for (const UnwrapMethod method : options.param.methods)
      json["options"]["methods"].push_back(unwrap_method_name(method));
  }
  return json;
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

Json pareto_json(const std::vector<EvaluationGroup>& groups) {
  Json json = Json::array();
  for (const EvaluationGroup& group : groups)
    json.push_back({{"input", group.input}, {"error_name", group.error_name}, {"front", group.on_front}});
  return json;
}

Json stability_json(const std::vector<StabilitySuite>& suites) {
  Json json = Json::array();
  for (const StabilitySuite& suite : suites) {
    Json cells = Json::array();
    for (const StabilityCell& cell : suite.cells)
      cells.push_back({{"method", cell.method},
                       {"input", cell.input},
                       {"outcome", to_string(cell.outcome)},
                       {"error", or_null(cell.error)},
                       {"residual", or_null(cell.residual)},
                       {"iterations", or_null(cell.iterations)},
                       {"seconds", cell.seconds},
                       {"note", cell.note}});
    json.push_back({{"name", suite.name},
                    {"title", suite.title},
                    {"error_name", suite.error_name},
                    {"residual_name", suite.residual_name},
                    {"cells", std::move(cells)}});
  }
  return json;
}

}  // namespace papilla::app
