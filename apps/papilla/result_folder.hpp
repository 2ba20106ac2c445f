// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <system_error>
#include <utility>

#include "papilla/core/atomic_file.hpp"

namespace papilla::app {

/// A folder for results. One that was made for them is removed again when it stays empty.
class ResultFolder {
 public:
  /// @throws IoError when `path` can't be made a folder.
  explicit ResultFolder(std::filesystem::path path) : path_(std::move(path)), is_new_(make_folder(path_)) {}
  ~ResultFolder() {
    std::error_code not_empty;
    if (is_new_) std::filesystem::remove(path_, not_empty);
  }
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  bool is_new_;
};

}  // namespace papilla::app
