// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace papilla {

/// The folders in which a program may read and write for someone who only talks to it: docs/security.md.
class AllowedFolders {
 public:
  /// @param folders that exist. @throws IoError when one does not.
  explicit AllowedFolders(const std::vector<std::filesystem::path>& folders);

  /// The file that a path leads to, all symbolic links resolved, whether it exists or not.
  /// @param path relative ones start in `base`. @throws InvalidInput quoting the path when the file is in none of the
  /// folders nor below one, or is there and no regular file.
  std::filesystem::path file(const std::filesystem::path& path, const std::filesystem::path& base) const;

  /// Their true names.
  const std::vector<std::filesystem::path>& folders() const noexcept { return folders_; }

 private:
  std::vector<std::filesystem::path> folders_;
};

/// The texts of a MATERIALS.json that may be paths: pictures, photographs, lights, references, environments.
/// @throws InvalidInput when it is no JSON. @param name stands for the file in messages.
std::set<std::string> paths_of_materials(const std::string& document, const std::string& name);

}  // namespace papilla
