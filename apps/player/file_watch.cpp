// SPDX-License-Identifier: MIT
#include "file_watch.hpp"

#include <sys/stat.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace papilla::player {

FileStamp stamp_of(const std::filesystem::path& path) noexcept {
  struct stat s {};
  if (::stat(path.c_str(), &s) != 0) return {};
  return {s.st_dev, s.st_ino, s.st_size, std::int64_t{1000000000} * s.st_mtim.tv_sec + s.st_mtim.tv_nsec};
}

FileWatch::FileWatch(std::filesystem::path path, const FileStamp& stamp, std::atomic<bool>& stop)
    : thread_([this, path = std::move(path), stamp, &stop](const std::stop_token& ends) {
        std::mutex mutex;
        std::condition_variable_any bell;
        std::unique_lock lock(mutex);
        while (!ends.stop_requested() && !changed_) {
          bell.wait_for(lock, ends, std::chrono::milliseconds(100), [] { return false; });
          if (stamp_of(path) == stamp) continue;
          changed_ = true;
          stop = true;
        }
      }) {}

}  // namespace papilla::player
