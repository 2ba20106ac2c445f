// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "evaluate/evaluation_files.hpp"
#include "html_text.hpp"
#include "shown_format.hpp"

namespace papilla::app {
namespace {

constexpr std::array k_outcomes = {Outcome::holds, Outcome::falls_back, Outcome::refuses,
                                   Outcome::fails, Outcome::breaks,     Outcome::not_run};
constexpr const char* k_legend =
    "holds: a valid result. falls back: a valid result by another method, named in the notes. refuses and fails: a "
    "clear "
    "error and no result. breaks: a result that can't be used. not run: the time was spent.";

/// The distinct names, in the order of their first cells.
std::vector<std::string> names_of(const StabilitySuite& suite, std::string StabilityCell::*name) {
  std::vector<std::string> names;
  for (const StabilityCell& cell : suite.cells)
    if (std::find(names.begin(), names.end(), cell.*name) == names.end()) names.push_back(cell.*name);
  return names;
}

const StabilityCell& cell_of(const StabilitySuite& suite, const std::string& method, const std::string& input) {
  return *std::find_if(suite.cells.begin(), suite.cells.end(),
                       [&](const StabilityCell& cell) { return cell.method == method && cell.input == input; });
}

template <class T>
std::string number(const std::optional<T>& value) {
  return value ? fmt::format("{:.3g}", static_cast<double>(*value)) : std::string("–");
}

std::string cell_text(const StabilityCell& cell) {
  std::string text{to_string(cell.outcome)};
  if (cell.error) text += " " + number(cell.error);
  return text;
}

std::size_t count(const StabilitySuite& suite, Outcome outcome) {
  return static_cast<std::size_t>(std::count_if(suite.cells.begin(), suite.cells.end(),
                                                [&](const StabilityCell& cell) { return cell.outcome == outcome; }));
}

std::string counts_of(const StabilitySuite& suite) {
  std::string text;
  for (const Outcome outcome : k_outcomes)
    if (const std::size_t n = count(suite, outcome); n > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", to_string(outcome), n);
  return text;
}

/// A text as the content of a Markdown table's cell, markup escaped.
std::string markdown_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '*' || c == '_' || c == '`' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string outcome_class(Outcome outcome) {
  return outcome == Outcome::breaks ? "bad" : outcome == Outcome::holds ? "good" : "other";
}

}  // namespace

std::string stability_csv(const std::vector<StabilitySuite>& suites) {
  std::string csv = "suite,method,input,outcome,error,residual,iterations,seconds,note\r\n";
  const auto field = [](const auto& value) { return value ? fmt::format("{}", *value) : std::string(); };
  for (const StabilitySuite& suite : suites)
    for (const StabilityCell& cell : suite.cells)
      csv += fmt::format("{},{},{},{},{},{},{},{},{}\r\n", suite.name, csv_field(cell.method), csv_field(cell.input),
                         to_string(cell.outcome), field(cell.error), field(cell.residual), field(cell.iterations),
                         cell.seconds, csv_field(cell.note));
  return csv;
}

std::string stability_markdown(const std::vector<StabilitySuite>& suites) {
  std::string md = "# Where each method holds and where it breaks\n\nMade by `papilla evaluate stability`. " +
                   std::string(k_legend) + " A dash: the number has no meaning there.\n";
  for (const StabilitySuite& suite : suites) {
    const auto methods = names_of(suite, &StabilityCell::method), inputs = names_of(suite, &StabilityCell::input);
    md += fmt::format("\n## {}\n\n{}. The number is the {}.\n\n| input |", suite.title, counts_of(suite),
                      suite.error_name);
    for (const std::string& method : methods) md += " " + markdown_text(method) + " |";
    md += "\n|---|";
    for (std::size_t i = 0; i < methods.size(); ++i) md += "---|";
    md += "\n";
    for (const std::string& input : inputs) {
      md += "| " + markdown_text(input) + " |";
      for (const std::string& method : methods) md += " " + cell_text(cell_of(suite, method, input)) + " |";
      md += "\n";
    }
    md += fmt::format(
        "\nResidual: {}.\n\n| method | input | outcome | error | residual | iterations | note |\n"
        "|---|---|---|---|---|---|---|\n",
        suite.residual_name);
    for (const StabilityCell& cell : suite.cells)
      md += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", markdown_text(cell.method), markdown_text(cell.input),
                        to_string(cell.outcome), number(cell.error), number(cell.residual),
                        cell.iterations ? number(cell.iterations) : "direct",
                        cell.note.empty() ? "–" : markdown_text(cell.note));
  }
  return md;
}

std::string stability_html(const std::vector<StabilitySuite>& suites) {
  std::string html =
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><meta name='color-scheme' content='light dark'>"
      "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; style-src 'unsafe-inline'\">"
      "<title>Stability</title><style>body{font-family:sans-serif;margin:2em}table{border-collapse:collapse;margin:1em "
      "0}"
      "td,th{padding:2px 8px;text-align:left;border:1px solid #8886}.bad{font-weight:bold;background:#d5550044}"
      ".other{background:#e69f0022}</style></head><body>\n<h1>Where each method holds and where it breaks</h1>\n<p>" +
      html_text(k_legend) + " Point at a cell for the rest.</p>\n";
  for (const StabilitySuite& suite : suites) {
    const auto methods = names_of(suite, &StabilityCell::method), inputs = names_of(suite, &StabilityCell::input);
    html += fmt::format("<h2>{}</h2>\n<p>{}. The number is the {}.</p>\n<table><tr><th>input</th>",
                        html_text(suite.title), counts_of(suite), html_text(suite.error_name));
    for (const std::string& method : methods) html += "<th>" + html_text(method) + "</th>";
    html += "</tr>\n";
    for (const std::string& input : inputs) {
      html += "<tr><th>" + html_text(input) + "</th>";
      for (const std::string& method : methods) {
        const StabilityCell& cell = cell_of(suite, method, input);
        const std::string rest =
            fmt::format("{}: {}; iterations: {}; {:.3g} s; {}", suite.residual_name, number(cell.residual),
                        cell.iterations ? number(cell.iterations) : "direct", cell.seconds, cell.note);
        html += fmt::format("<td class='{}' title='{}'>{}</td>", outcome_class(cell.outcome), html_text(rest),
                            cell_text(cell));
      }
      html += "</tr>\n";
    }
    html += "</table>\n";
  }
  return html + "</body></html>\n";
}

std::string stability_summary(const std::vector<StabilitySuite>& suites) {
  std::string text;
  for (const StabilitySuite& suite : suites) {
    text += shown_format("{:<28} {}\n", suite.title, counts_of(suite));
    for (const StabilityCell& cell : suite.cells)
      if (cell.outcome == Outcome::breaks)
        text += shown_format("  breaks: {} on {}: {}\n", cell.method, cell.input, cell.note);
  }
  return text;
}

}  // namespace papilla::app
