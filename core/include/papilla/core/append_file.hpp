// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace papilla {

/// A text file that grows line by line and survives the end of the process at any moment: a line that append() returned
/// from is on the disk, and a line that was being written is whole or is removed when the file is opened again. For
/// what write_atomically() can't do: results that come one by one from people.
class AppendFile {
 public:
  /// Opens the file, or makes it, and locks it against other processes until the object ends.
  /// @throws IoError naming it and the reason: it is no regular file, can't be opened, or another process appends to
  /// it; OverwriteRefused as note_output() of file_guard.hpp.
  explicit AppendFile(const std::filesystem::path& path);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  /// What it held when it was opened: whole lines.
  const std::string& content() const noexcept { return content_; }
  /// Of a last line without end, which was removed.
  std::size_t removed_bytes() const noexcept { return removed_bytes_; }

  /// Adds a line and its end, and waits for the disk. @pre `line` has no line feed.
  /// @throws IoError naming the file and the reason; it then holds nothing of the line.
  void append(std::string_view line);

 private:
  [[noreturn]] void fail(int reason) const;

  std::filesystem::path path_;
  std::string content_;
  std::size_t removed_bytes_ = 0;
  int file_ = -1;
};

}  // namespace papilla
