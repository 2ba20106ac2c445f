// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/page_file.hpp"

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"

namespace papilla::app {
namespace {

/// JSON that may stand in a script element: no "<" in it.
std::string embedded(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

}  // namespace

std::size_t write_page(const PageContent& content, const std::filesystem::path& file) {
  const std::string_view page = page_template();
  std::string html;
  if (page.empty()) {
    html = plain_page(content);
  } else {
    const std::size_t marker = page.find(k_page_marker);
    html = page.substr(0, marker);
    html += embedded({{"program", std::string("papilla ") + version()},
                      {"title", content.title},
                      {"scene", content.scene},
                      {"report", content.report}});
    html += page.substr(marker + k_page_marker.size());
  }
  write_atomically(file, html);
  return html.size();
}

}  // namespace papilla::app
