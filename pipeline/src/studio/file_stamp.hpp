// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace papilla {

/// Differs when a file has other content than before, as far as its time and size tell; empty: there is none.
inline std::string file_stamp(const std::filesystem::path& file) {
  std::error_code error;
  if (file.empty() || !std::filesystem::is_regular_file(file, error)) return {};
  const auto time = std::filesystem::last_write_time(file, error).time_since_epoch().count();
  return std::to_string(time) + " " + std::to_string(std::filesystem::file_size(file, error));
}

}  // namespace papilla
