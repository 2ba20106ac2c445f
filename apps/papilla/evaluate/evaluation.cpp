// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "pictures/trace_plot.hpp"

namespace papilla::app {
namespace {

constexpr std::array<EvaluationKind, 7> k_kinds = {{
    {"param", "every method of unwrap on one chart: distortion against run time", evaluate_param},
    {"weld", "tolerance of the weld against boundary edges left and deviation", evaluate_weld},
    {"simplification", "tolerance of simplify against triangles left and deviation", evaluate_simplification},
    {"tessellation", "chord of CAD tessellation against deviation", evaluate_tessellation},
    {"fractal", "size of the picture against the interval of every fractal dimension", evaluate_fractal},
    {"symmetry", "size of the picture against what the lattice leaves unexplained", evaluate_symmetry},
    {"height", "steps of shape from shading against depth error or residual", evaluate_height},
}};

std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string out = "\"";
  for (const char c : field) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::span<const EvaluationKind> evaluation_kinds() { return k_kinds; }

Json runs_json(const std::vector<EvaluationRun>& runs) {
  Json json = Json::array();
  for (const EvaluationRun& run : runs) {
    Json trace = Json::array();
    for (const TraceSample& s : run.trace) trace.push_back({{"seconds", s.seconds}, {"error", s.error}});
    json.push_back({{"method", run.method},
                    {"solver", run.solver},
                    {"input", run.input},
                    {"error_name", run.error_name},
                    {"trace", std::move(trace)},
                    {"stop", run.stop},
                    {"notes", run.notes}});
  }
  return json;
}

std::string runs_csv(const std::vector<EvaluationRun>& runs) {
  std::string csv = "method,solver,input,error_name,seconds,error\r\n";
  for (const EvaluationRun& run : runs)
    for (const TraceSample& s : run.trace)
      csv += fmt::format("{},{},{},{},{},{}\r\n", quoted(run.method), quoted(run.solver), quoted(run.input),
                         quoted(run.error_name), s.seconds, s.error);
  return csv;
}

std::vector<EvaluationPicture> runs_pictures(const std::vector<EvaluationRun>& runs) {
  std::vector<std::pair<std::string, std::string>> order;
  std::map<std::pair<std::string, std::string>, std::vector<TraceCurve>> groups;
  for (const EvaluationRun& run : runs) {
    const std::pair key{run.input, run.error_name};
    if (!groups.contains(key)) order.push_back(key);
    groups[key].push_back({run.solver.empty() ? run.method : run.method + " (" + run.solver + ")", run.trace});
  }
  std::vector<EvaluationPicture> pictures;
  for (const auto& key : order) {
    std::vector<TraceCurve>& curves = groups[key];
    mark_front(curves);
    EvaluationPicture picture{key.first + ": " + key.second, trace_plot_svg(key.first, key.second, curves), {}};
    for (const TraceCurve& curve : curves)
      if (curve.in_front) picture.front.push_back(curve.name);
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

std::string runs_html(const std::string& kind, const std::vector<EvaluationPicture>& pictures,
                      const std::vector<EvaluationRun>& runs) {
  const auto text = [](const std::string& s) {
    std::string out;
    for (const char c : s) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
    return out;
  };
  std::string html = "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>Evaluation: " + text(kind) +
                     "</title><style>body{font-family:sans-serif;margin:2em}td,th{padding:2px 10px;text-align:left;"
                     "border-bottom:1px solid #ddd}td.n{text-align:right}</style></head><body>\n<h1>Evaluation: " +
                     text(kind) + "</h1>\n<p>Grey: what no other run beats in both error and time.</p>\n";
  for (const EvaluationPicture& picture : pictures) html += picture.svg;
  html +=
      "<table><tr><th>method</th><th>variant</th><th>input</th><th>error</th><th>last seconds</th>"
      "<th>last error</th><th>stop</th><th>notes</th></tr>\n";
  for (const EvaluationRun& run : runs) {
    const TraceSample last = run.trace.empty() ? TraceSample{} : run.trace.back();
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td class='n'>{:.4g}</td><td class='n'>{:.5g}"
        "</td><td>{}</td><td>{}</td></tr>\n",
        text(run.method), text(run.solver), text(run.input), text(run.error_name), last.seconds, last.error,
        text(run.stop), text(run.notes));
  }
  return html + "</table></body></html>\n";
}

std::vector<std::uint32_t> largest_parts(const Scene& scene, std::size_t most) {
  std::vector<std::uint32_t> order(scene.parts.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return scene.parts[a].mesh.triangles.size() > scene.parts[b].mesh.triangles.size();
  });
  order.resize(std::min(order.size(), most));
  return order;
}

}  // namespace papilla::app
