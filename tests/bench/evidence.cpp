// SPDX-License-Identifier: MIT
#include "evidence.hpp"

#include <fmt/core.h>

namespace papilla::bench {
namespace {

using Json = nlohmann::ordered_json;

/// A bar would end the cell.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c == '\n' ? ' ' : c;
  }
  return escaped;
}

std::string row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& text : cells) line += " " + cell(text) + " |";
  return line + "\n";
}

std::string markdown_table(const std::vector<std::string>& columns, const std::vector<std::vector<std::string>>& rows) {
  std::string text = row(columns) + row(std::vector<std::string>(columns.size(), "---"));
  for (const auto& cells : rows) text += row(cells);
  return text + "\n";
}

std::string text_of(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

std::string provenance(const Json& report, const std::string& command) {
  const Json &machine = report.at("machine"), &compiler = report.at("compiler");
  return fmt::format(
      "Written by `{}` on {}, commit {}; {}, {} cores; {} {} {}; {} repeats, {} threads. Processor times vary from "
      "machine to machine; ratios and counts should not.\n\n",
      command, text_of(report.at("started")), text_of(report.at("commit")), text_of(machine.at("cpu")),
      text_of(machine.at("cores")), text_of(compiler.at("name")), text_of(compiler.at("version")),
      text_of(compiler.at("flags")), text_of(report.at("repeats")), text_of(report.at("threads")));
}

std::string targets_table(const std::vector<Target>& targets) {
  std::vector<std::vector<std::string>> rows;
  for (const Target& t : targets)
    rows.push_back({t.promise, t.measured, !t.holds ? "not measured" : *t.holds ? "yes" : "**no**"});
  return "## Targets\n\n" + markdown_table({"target", "measured", "holds"}, rows);
}

std::string ratios_table(const Json& ratios) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& r : ratios)
    rows.push_back({text_of(r.at("method")), text_of(r.at("peer")), text_of(r.at("input")), text_of(r.at("quantity")),
                    fmt::format("{:.3g}", r.at("ratio").get<double>()),
                    fmt::format("{:.3g} to {:.3g}", r.at("low").get<double>(), r.at("high").get<double>())});
  return "## Ratios\n\n" + markdown_table({"method", "peer", "input", "quantity", "ratio", "extremes"}, rows);
}

}  // namespace

std::string evidence_page(const Json& report, const std::vector<Target>& targets,
                          const std::vector<EvidenceTable>& tables, const std::string& command) {
  std::string page = fmt::format("# {}: what was measured\n\n", text_of(report.at("summary")));
  page += provenance(report, command);
  if (!targets.empty()) page += targets_table(targets);
  for (const EvidenceTable& table : tables) {
    page += fmt::format("## {}\n\n", table.title);
    if (!table.note.empty()) page += table.note + "\n\n";
    page += markdown_table(table.columns, table.rows);
  }
  if (report.contains("ratios") && !report.at("ratios").empty()) page += ratios_table(report.at("ratios"));
  page.pop_back();
  return page;
}

}  // namespace papilla::bench
