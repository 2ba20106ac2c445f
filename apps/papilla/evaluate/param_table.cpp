// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/param_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "evaluate/evaluation_files.hpp"
#include "papilla/core/error.hpp"
#include "papilla/pipeline/measure_scene.hpp"
#include "shown_format.hpp"

namespace papilla::app {
namespace {

using Cells = std::vector<std::pair<const char*, Json>>;

std::string outcome(const EvaluatedMap& map) {
  return !map.failure.empty() ? "no result" : map.valid ? "valid" : "not valid";
}

/// Numbers of maps without a triangle of any area say nothing.
bool has_numbers(const EvaluatedMap& map) { return map.failure.empty() && map.distortion.measured_triangles > 0; }

/// A row under the names of its columns.
Cells cells_of(const EvaluationRun& run, const ParamComparison& comparison) {
  const EvaluatedMap& map = *run.map;
  const DistortionReport& d = map.distortion;
  const auto count = [&](auto value) { return map.failure.empty() ? Json(value) : Json(); };
  const auto number = [&](double value) { return has_numbers(map) && std::isfinite(value) ? Json(value) : Json(); };
  return {{"input", map.input},
          {"method", run.method},
          {"solver", run.solver},
          {"chart_source", chart_source_name(comparison.charts)},
          {"normalize", uv_normalization_name(comparison.normalize)},
          {"outcome", outcome(map)},
          {"triangles", map.triangles},
          {"given_charts", map.given_charts},
          {"charts", count(map.charts)},
          {"replaced_charts", count(map.replaced)},
          {"flipped", count(d.flipped)},
          {"degenerate_uv", count(d.degenerate_uv)},
          {"overlap_within_charts", number(d.overlap_within_charts)},
          {"symmetric_dirichlet_mean", number(d.symmetric_dirichlet.mean)},
          {"symmetric_dirichlet_max", number(d.symmetric_dirichlet.max)},
          {"stretch_l2", number(d.stretch_l2)},
          {"stretch_linf", number(d.stretch_linf)},
          {"conformal_mean", number(d.conformal.mean)},
          {"conformal_max", number(d.conformal.max)},
          {"angle_error_deg_mean", number(d.angle_error_deg.mean)},
          {"angle_error_deg_max", number(d.angle_error_deg.max)},
          {"area_ratio_min", number(d.area_ratio.min)},
          {"area_ratio_mean", number(d.area_ratio.mean)},
          {"area_ratio_max", number(d.area_ratio.max)},
          {"edge_length_error", number(d.edge_length_error)},
          {"note", map.failure}};
}

template <class Visit>
void each_row(const std::vector<EvaluationRun>& runs, const Visit& visit) {
  for (const EvaluationRun& run : runs)
    if (run.map) visit(run);
}

std::string csv_value(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_string()) return csv_field(value.get<std::string>());
  return value.is_number_float() ? fmt::format("{:.9g}", value.get<double>()) : value.dump();
}

/// Five significant digits, powers of ten as people write them; a dash for what there is not.
std::string latex_number(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return "--";
  const std::string text = fmt::format("{:.5g}", *value);
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text[0] == '-' ? "$" + text + "$" : text;
  return fmt::format("${}\\times10^{{{}}}$", text.substr(0, e), std::stoi(text.substr(e + 1)));
}

std::string latex_row(const EvaluationRun& run, const std::string& input) {
  const EvaluatedMap& map = *run.map;
  const DistortionReport& d = map.distortion;
  std::string row = input + " & " + latex_text(run.name());
  if (map.failure.empty() && !map.valid) row += "$^\\dagger$";
  for (const std::size_t count : {static_cast<std::size_t>(map.charts), map.replaced, d.flipped})
    row += map.failure.empty() ? fmt::format(" & {}", count) : " & --";
  for (const double value : {d.symmetric_dirichlet.mean, d.symmetric_dirichlet.max, d.stretch_l2, d.stretch_linf,
                             d.angle_error_deg.mean, d.angle_error_deg.max, d.area_ratio.min, d.area_ratio.max})
    row += " & " + latex_number(has_numbers(map) ? std::optional(value) : std::nullopt);
  return row + " \\\\\n";
}

std::string charts_in_words(ChartSource source) {
  switch (source) {
    case ChartSource::automatic: return "one chart of each input";
    case ChartSource::keep: return "each connected component as one chart";
    case ChartSource::uv: break;
  }
  return "charts between the seams of the input's own texture coordinates";
}

std::string scale_in_words(UvNormalization normalization) {
  if (normalization == UvNormalization::none) return "texture coordinates as they are, in millimetres";
  const bool by_chart = normalization == UvNormalization::chart;
  return std::string("texture coordinates scaled by one factor per ") + (by_chart ? "chart" : "input") +
         " to the area of the surface";
}

std::string caption(const ParamComparison& comparison) {
  return fmt::format(
      "Distortion of maps to the plane: {}, the same for all methods; {}. "
      "$E_\\mathrm{{SD}} = \\sigma_1^2 + \\sigma_2^2 + \\sigma_1^{{-2}} + \\sigma_2^{{-2}}$ (isometry: 4), "
      "$L_2$ and $L_\\infty$ stretch (isometry: 1), angle error (isometry: 0), area ratio $\\sigma_1\\sigma_2$ "
      "(isometry: 1); means are weighted by area. Repl.: charts without a valid map by the method, which got another "
      "one. $^\\dagger$ not valid: triangles flipped, without area or overlapping in a chart. --: no result.",
      charts_in_words(comparison.charts), scale_in_words(comparison.normalize));
}

}  // namespace

std::string latex_text(const std::string& text) {
  std::string out;
  for (const char c : shown(text)) {
    switch (c) {
      case '\\': out += "\\textbackslash{}"; break;
      case '~': out += "\\textasciitilde{}"; break;
      case '^': out += "\\textasciicircum{}"; break;
      case '<': out += "\\textless{}"; break;
      case '>': out += "\\textgreater{}"; break;
      case '|': out += "\\textbar{}"; break;
      case '"': out += "''"; break;
      case '&':
      case '%':
      case '$':
      case '#':
      case '_':
      case '{':
      case '}': out += '\\'; [[fallthrough]];
      default: out += c;
    }
  }
  return out;
}

std::string param_csv(const std::vector<EvaluationRun>& runs, const ParamComparison& comparison) {
  std::string csv;
  const auto add_line = [&](const std::vector<std::string>& fields) {
    csv += fmt::format("{}\r\n", fmt::join(fields, ","));
  };
  each_row(runs, [&](const EvaluationRun& run) {
    std::vector<std::string> names, values;
    for (const auto& [name, value] : cells_of(run, comparison)) {
      names.emplace_back(name);
      values.push_back(csv_value(value));
    }
    if (csv.empty()) add_line(names);
    add_line(values);
  });
  return csv;
}

Json param_rows_json(const std::vector<EvaluationRun>& runs, const ParamComparison& comparison) {
  Json rows = Json::array();
  each_row(runs, [&](const EvaluationRun& run) {
    Json row;
    for (const auto& [name, value] : cells_of(run, comparison)) row[name] = value;
    rows.push_back(std::move(row));
  });
  return rows;
}

std::string param_latex(const std::vector<EvaluationRun>& runs, const ParamComparison& comparison,
                        const std::string& command) {
  std::string latex = fmt::format(
      "% papilla {}: {}\n"
      "% Needs \\usepackage{{booktabs}}.\n"
      "\\begin{{table*}}\n"
      "\\centering\\footnotesize\n"
      "\\caption{{{}}}\n"
      "\\label{{tab:papilla-param}}\n"
      "\\begin{{tabular}}{{llrrrrrrrrrrr}}\n"
      "\\toprule\n"
      "Input & Method & Charts & Repl. & Flipped & \\multicolumn{{2}}{{c}}{{$E_\\mathrm{{SD}}$}} & $L_2$ & $L_\\infty$ "
      "& \\multicolumn{{2}}{{c}}{{Angle error [$^\\circ$]}} & \\multicolumn{{2}}{{c}}{{Area ratio}} \\\\\n"
      "\\cmidrule(lr){{6-7}}\\cmidrule(lr){{10-11}}\\cmidrule(lr){{12-13}}\n"
      " & & & & & mean & max & & & mean & max & min & max \\\\\n",
      version(), shown(command), caption(comparison));
  std::optional<std::string> last;
  each_row(runs, [&](const EvaluationRun& run) {
    const bool is_new = last != run.map->input;
    if (is_new) latex += "\\midrule\n";
    latex += latex_row(run, is_new ? latex_text(run.map->input) : "");
    last = run.map->input;
  });
  return latex + "\\bottomrule\n\\end{tabular}\n\\end{table*}\n";
}

}  // namespace papilla::app
