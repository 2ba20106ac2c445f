// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/page_file.hpp"

#include <utility>
#include <vector>

#include "json/embedded_json.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"

namespace papilla::app {
namespace {

/// The template with texts in place of its markers, which come in this order.
std::string fill(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& texts) {
  std::string html;
  for (const auto& [marker, text] : texts) {
    const std::size_t at = page.find(marker);
    html += page.substr(0, at);
    html += text;
    page.remove_prefix(at + marker.size());
  }
  html += page;
  return html;
}

}  // namespace

std::string page_html(const PageContent& content) {
  const std::string_view page = page_template();
  if (page.empty()) return plain_page(content);
  const Json data = {{"program", std::string("papilla ") + version()},
                     {"title", content.title},
                     {"scene", content.scene},
                     {"report", content.report},
                     {"live", content.live},
                     {"looks", content.looks}};
  const bool asks = content.live || !content.looks.is_null();
  return fill(page, {{k_connect_marker, asks ? "; connect-src 'self'" : ""}, {k_page_marker, embedded_json(data)}});
}

std::size_t write_page(const PageContent& content, const std::filesystem::path& file) {
  const std::string html = page_html(content);
  write_atomically(file, html);
  return html.size();
}

}  // namespace papilla::app
