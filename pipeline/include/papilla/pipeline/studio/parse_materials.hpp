// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "papilla/pipeline/materials.hpp"

namespace papilla {

/// read_materials() of a text that stands, or will stand, in the file `path`.
/// @throws InvalidInput, IoError as read_materials().
Materials parse_materials(const std::string& text, const std::filesystem::path& path,
                          const std::filesystem::path& library = {});

}  // namespace papilla
