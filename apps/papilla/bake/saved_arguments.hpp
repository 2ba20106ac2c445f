// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "bake/bake_arguments.hpp"

namespace papilla::app {

/// Writes FOLDER/bake.json: what the command line of split said of the bake, and the sums of the files that it names.
void save_arguments(const CLI::App& verb, const std::filesystem::path& folder);

/// The arguments of FOLDER/bake.json.
/// @throws IoError; InvalidInput naming the file when it is no such file, or when a file that it names has changed.
BakeArguments read_arguments(const std::filesystem::path& folder);

}  // namespace papilla::app
