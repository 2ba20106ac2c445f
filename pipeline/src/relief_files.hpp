// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/pipeline/height_file.hpp"

namespace papilla {

/// Writes the relief of `files.result` and what else the options ask for, and names the files.
void write_relief_files(HeightFiles& files, const std::filesystem::path& output, const HeightFileOptions& options);

}  // namespace papilla
