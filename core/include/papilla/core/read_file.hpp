// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace papilla {

/// Checks that a path leads to a regular file, and notes it as an input (file_guard.hpp).
/// @throws IoError when it is missing, a directory or a device; OverwriteRefused as note_input().
void require_file(const std::filesystem::path& path);

/// The bytes of a regular file, in one read. Never waits for a pipe.
/// @throws IoError when it is missing, a directory or a device, or can't be read; OverwriteRefused as note_input().
std::string read_file(const std::filesystem::path& path);

}  // namespace papilla
