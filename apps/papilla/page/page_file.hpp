// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "verb.hpp"

namespace papilla::app {

/// What a page shows. `scene` is that of page_scene_json(); `report` that of bake, or null.
struct PageContent {
  std::string title;
  Json scene, report;
};

/// Writes one self-contained HTML file: the page with the content in it, or tables of the content when the program was
/// built without the page. The content is data, never markup: names with markup in them are shown as they are.
/// @return the number of bytes.
/// @throws IoError when the file can't be written.
std::size_t write_page(const PageContent& content, const std::filesystem::path& file);

/// The content as tables, without scripts.
std::string plain_page(const PageContent& content);

/// The bundled page with k_page_marker where the data goes; empty when the program was built without it.
std::string_view page_template() noexcept;
inline constexpr std::string_view k_page_marker = "@PAPILLA_DATA@";

}  // namespace papilla::app
