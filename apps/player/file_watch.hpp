// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <thread>

namespace papilla::player {

/// Which file stands under a name, and in what state.
struct FileStamp {
  dev_t device = 0;
  ino_t inode = 0;
  off_t bytes = -1;  ///< −1: there is none.
  std::int64_t changed_ns = 0;
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};
FileStamp stamp_of(const std::filesystem::path& path) noexcept;

/// A thread that looks at a file ten times a second and sets `stop` when it is another one than `stamp`: written to,
/// truncated, replaced or gone. It ends with the object.
class FileWatch {
 public:
  /// @param stop must outlive the object.
  FileWatch(std::filesystem::path path, const FileStamp& stamp, std::atomic<bool>& stop);
  bool changed() const noexcept { return changed_; }

 private:
  std::atomic<bool> changed_{false};
  std::jthread thread_;
};

}  // namespace papilla::player
