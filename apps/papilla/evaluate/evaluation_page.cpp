// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "evaluate/evaluation_files.hpp"
#include "html_text.hpp"

namespace papilla::app {
namespace {

/// The root element of an SVG file, for use in an HTML page.
std::string_view svg_element(std::string_view svg) {
  const std::size_t root = svg.find("<svg");
  return root == std::string_view::npos ? svg : svg.substr(root);
}

std::string last_of(const EvaluationRun& run) {
  if (run.trace.empty()) return html_text(run.stop);
  const TraceSample& last = run.trace.back();
  return fmt::format("{:.4g}<br><small>{:.3g} s, {}{}</small>", last.error, last.seconds, html_text(run.stop),
                     run.valid ? "" : ", <b>not valid</b>");
}

/// Table of methods against inputs: the last error, its time and the stop reason.
std::string matrix_of(const std::string& error_name, const std::vector<const EvaluationRun*>& runs) {
  std::vector<std::string> inputs, methods;
  std::map<std::pair<std::string, std::string>, const EvaluationRun*> cell;
  const auto note = [](std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  for (const EvaluationRun* run : runs) {
    note(inputs, run->input);
    note(methods, run->name());
    cell[{run->name(), run->input}] = run;
  }
  std::string html = "<h2>" + html_text(error_name) + "</h2>\n<table><tr><th>method</th>";
  for (const std::string& input : inputs) html += "<th>" + html_text(input) + "</th>";
  html += "</tr>\n";
  for (const std::string& method : methods) {
    html += "<tr><th>" + html_text(method) + "</th>";
    for (const std::string& input : inputs) {
      const auto at = cell.find({method, input});
      html += "<td>" + (at == cell.end() ? "does not apply" : last_of(*at->second)) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string tables_of(const std::vector<EvaluationRun>& runs) {
  std::vector<std::pair<std::string, std::vector<const EvaluationRun*>>> by_error;
  for (const EvaluationRun& run : runs) {
    auto at = std::find_if(by_error.begin(), by_error.end(), [&](const auto& e) { return e.first == run.error_name; });
    if (at == by_error.end()) at = by_error.insert(by_error.end(), {run.error_name, {}});
    at->second.push_back(&run);
  }
  std::string html;
  for (const auto& [error_name, list] : by_error) html += matrix_of(error_name, list);
  html += "<h2>Notes</h2>\n<table><tr><th>method</th><th>input</th><th>notes</th></tr>\n";
  for (const EvaluationRun& run : runs)
    if (!run.notes.empty())
      html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", html_text(run.name()), html_text(run.input),
                          html_text(run.notes));
  return html + "</table>\n";
}

}  // namespace

std::string runs_html(const std::string& kind, const std::vector<EvaluationPicture>& pictures,
                      const std::vector<EvaluationRun>& runs) {
  std::string html =
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><meta name='color-scheme' content='light dark'>"
      "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; style-src 'unsafe-inline'\"><title>"
      "Evaluation: " +
      html_text(kind) +
      "</title><style>body{font-family:sans-serif;margin:2em}table{border-collapse:collapse}td,th{padding:2px 10px;"
      "text-align:left;vertical-align:top;border-bottom:1px solid #8886}svg{max-width:100%;height:auto;display:block;"
      "margin:1em 0}</style></head><body>\n<h1>Evaluation: " +
      html_text(kind) + "</h1>\n";
  html += pictures.empty() ? "<p>No plots: gnuplot is not installed, or there is nothing to draw.</p>\n"
                           : "<p>Every dot is a measurement; the lines join medians. Grey, and marked with *: what no "
                             "other valid run beats in both error and time. An error of 0 is drawn a decade below the "
                             "smallest other one.</p>\n";
  for (const EvaluationPicture& picture : pictures) html += svg_element(picture.svg);
  return html + tables_of(runs) + "</body></html>\n";
}

}  // namespace papilla::app
