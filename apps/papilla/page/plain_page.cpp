// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>
#include <vector>

#include "html_text.hpp"
#include "page/page_file.hpp"

namespace papilla::app {
namespace {

/// Streams of bytes are no reading.
bool is_bytes(const std::string& key) {
  static const std::set<std::string> keys = {"vertex_stream", "index_stream", "coarse_stream",
                                             "uv1_stream",    "png",          "bytes"};
  return keys.contains(key);
}

std::string value(const Json& json);

/// Objects of the same kind, a row each.
std::string rows(const Json& list) {
  std::vector<std::string> columns;
  for (const Json& row : list)
    for (const auto& [key, cell] : row.items())
      if (!is_bytes(key) && std::find(columns.begin(), columns.end(), key) == columns.end()) columns.push_back(key);
  std::string out = "<table><tr>";
  for (const std::string& column : columns) out += "<th>" + html_text(column) + "</th>";
  out += "</tr>";
  for (const Json& row : list) {
    out += "<tr>";
    for (const std::string& column : columns)
      out += "<td>" + (row.contains(column) ? value(row[column]) : "") + "</td>";
    out += "</tr>";
  }
  return out + "</table>";
}

std::string fields(const Json& object) {
  std::string out = "<table>";
  for (const auto& [key, field] : object.items())
    if (!is_bytes(key)) out += "<tr><th>" + html_text(key) + "</th><td>" + value(field) + "</td></tr>";
  return out + "</table>";
}

std::string value(const Json& json) {
  if (json.is_object()) return fields(json);
  if (json.is_array() && !json.empty() && json[0].is_object()) return rows(json);
  if (json.is_string()) return html_text(json.get<std::string>());
  return html_text(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

std::string plain_page(const PageContent& content) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"color-scheme\" content=\"light "
      "dark\">"
      "<title>" +
      html_text(content.title) +
      "</title><style>body{font-family:sans-serif;margin:2em}"
      "table{border-collapse:collapse}td,th{padding:2px 8px;text-align:left;vertical-align:top;border:1px solid #8886}"
      "</style></head><body>\n<h1>" +
      html_text(content.title) + "</h1>\n";
  if (!content.report.is_null()) html += "<h2>Report</h2>\n" + value(content.report) + "\n";
  return html + "<h2>Scene</h2>\n" + value(content.scene) + "\n</body></html>\n";
}

}  // namespace papilla::app
