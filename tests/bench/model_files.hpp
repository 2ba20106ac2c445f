// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace papilla::bench {

/// STEP, IGES or BREP, by its name.
bool is_cad_file(const std::filesystem::path& file);

/// The files that were given, and the CAD and mesh files in the folders among them, in the order of their names.
std::vector<std::filesystem::path> model_files(const std::vector<std::string>& inputs);

}  // namespace papilla::bench
