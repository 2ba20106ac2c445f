// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/sheet_page.hpp"

#include <fmt/format.h>

#include "html_text.hpp"

namespace papilla::app {
namespace {

/// What a caption says of a tile that is brighter than its recipe.
std::string brightened(double exposure) {
  return exposure >= 1.05 ? fmt::format(" ({:.1f} times as bright)", exposure) : std::string();
}

}  // namespace

std::string sheet_page(const ContactSheet& sheet, const std::string& picture_file) {
  std::string page =
      "<!doctype html><meta charset=\"utf-8\"><title>Recipes</title><style>body{font:14px "
      "sans-serif;margin:2em}td,th{padding:2px 8px;"
      "text-align:left;vertical-align:top;border-bottom:1px solid "
      "#ccc}code{font-size:12px;overflow-wrap:anywhere}</style>\n";
  const int side = (sheet.picture.width - k_sheet_gap_px) / sheet.columns - k_sheet_gap_px;
  page += fmt::format(
      "<style>figure{{display:inline-block;margin:0 6px 10px "
      "0}}figcaption{{font-size:12px;max-width:{0}px}}.t{{width:{0}px;"
      "height:{0}px;background:url({1})}}</style>\n<h1>Recipes</h1>\n<div>",
      side, picture_file);
  for (std::size_t k = 0; k < sheet.entries.size(); ++k) {
    const int column = static_cast<int>(k) % sheet.columns, row = static_cast<int>(k) / sheet.columns;
    const std::string name = html_text(sheet.entries[k].name);
    page += fmt::format(
        "<figure><div class=\"t\" role=\"img\" aria-label=\"{}\" style=\"background-position:-{}px -{}px\"></div>"
        "<figcaption>{}{}</figcaption></figure>\n",
        name, k_sheet_gap_px + column * (side + k_sheet_gap_px), k_sheet_gap_px + row * (side + k_sheet_gap_px), name,
        brightened(sheet.entries[k].exposure));
  }
  page += "</div>\n";
  page += "<table><tr><th>name<th>recipe<th>rests on<th>height<th>mean<th>seam</tr>\n";
  for (const SheetEntry& e : sheet.entries) {
    std::string uses;
    for (const std::string& name : e.uses) uses += (uses.empty() ? "" : ", ") + name;
    page += fmt::format("<tr><td>{}<td><code>{}</code>", html_text(e.name), html_text(e.text));
    if (e.error.empty())
      page += fmt::format("<td>{}<td>{:.3f} to {:.3f}<td>{:.3f}<td>{:.2f}</tr>\n", html_text(uses), e.low, e.high,
                          e.mean, e.seam);
    else
      page += fmt::format("<td colspan=4>{}</tr>\n", html_text(e.error));
  }
  return page +
         "</table>\n<p>Seam: largest step of the height across the border over the largest step within; not above 1 "
         "where the texture tiles. An ageing recipe is shown on a material that it suits.</p>\n";
}

}  // namespace papilla::app
