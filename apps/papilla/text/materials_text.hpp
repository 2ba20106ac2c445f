// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/pipeline/material_library.hpp"
#include "papilla/pipeline/material_suggestion.hpp"

namespace papilla::app {

// The material library for people, as lines of a terminal.

/// A row a material: id, names, stiffness, friction.
std::string library_table(const std::vector<LibraryMaterial>& materials);

/// Every number of a material with its unit and where it comes from, then the citations.
std::string library_material_text(const LibraryMaterial& material);

/// A line a problem, then how many numbers are cited and how many estimated.
std::string library_check_text(const LibraryCheck& check);

/// A line a suggestion; says that nothing of it is applied. Empty without any.
std::string suggestions_text(const std::vector<MaterialSuggestion>& suggestions);

}  // namespace papilla::app
