// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/pipeline/library_material.hpp"

namespace papilla::app {

/// A material and where the page finds its picture: a file beside it, or a data: URI.
struct MaterialsPageEntry {
  const LibraryMaterial* material = nullptr;
  std::string picture;
};

/// A page to browse the library: a card a material with its picture, numbers and sources, and a search that knows both
/// languages as search_materials() does. It loads nothing but the pictures.
std::string materials_page(const std::vector<MaterialsPageEntry>& entries);

}  // namespace papilla::app
