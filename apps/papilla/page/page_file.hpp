// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "verb.hpp"

namespace papilla::app {

/// What a page shows. `scene` is that of page_scene(); `report` that of bake, or null.
struct PageContent {
  std::string title;
  Json scene, report;
  bool live = false;     ///< Follows a player: may ask its own server, and nobody else, for samples.
  Json looks = nullptr;  ///< Follows `weather --live`, and may ask as well: numbers of the page and of its looks.
};

/// One self-contained HTML text: the page with the content in it, or tables of the content when the program was built
/// without the page. The content is data, never markup: names with markup in them are shown as they are.
std::string page_html(const PageContent& content);

/// Writes page_html() into a file.
/// @return the number of bytes.
/// @throws IoError when the file can't be written.
std::size_t write_page(const PageContent& content, const std::filesystem::path& file);

/// The content as tables, without scripts.
std::string plain_page(const PageContent& content);

/// The bundled page with k_page_marker and k_connect_marker; empty when the program was built without it.
std::string_view page_template() noexcept;
inline constexpr std::string_view k_page_marker = "@PAPILLA_DATA@";
/// Where a page that follows a player gets its one permission.
inline constexpr std::string_view k_connect_marker = "@PAPILLA_CONNECT@";

}  // namespace papilla::app
