// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace papilla {

/// @throws IoError when the path is missing, a directory or a device.
void require_file(const std::filesystem::path& path);

/// The bytes of a regular file, in one read.
/// @throws IoError when it is missing, a directory or a device, or can't be read.
std::string read_file(const std::filesystem::path& path);

}  // namespace papilla
