// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace papilla::app {

/// Looks whether files have another time or size than at the last look, which works on every file system. A file that
/// is being replaced counts when it is there again.
class FileWatch {
 public:
  /// @param files  asked anew at every look; one that joins the list is no change.
  explicit FileWatch(std::function<std::vector<std::filesystem::path>()> files);
  bool changed();

 private:
  using State = std::map<std::filesystem::path, std::pair<std::filesystem::file_time_type, std::uintmax_t>>;
  State look() const;

  std::function<std::vector<std::filesystem::path>()> files_;
  State last_;
};

}  // namespace papilla::app
