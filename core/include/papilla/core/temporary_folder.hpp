// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

namespace papilla {

/// A new, empty folder below the system's folder for temporary files, that only its owner can read. The destructor
/// removes it with its content.
class TemporaryFolder {
 public:
  /// @param purpose first word of its name.
  /// @throws IoError when it can't be made.
  explicit TemporaryFolder(std::string_view purpose);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const noexcept { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace papilla
