// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/file_watch.hpp"

#include <algorithm>
#include <system_error>

namespace papilla::app {

FileWatch::FileWatch(std::function<std::vector<std::filesystem::path>()> files) : files_(std::move(files)) {
  last_ = look();
}

/// A file that is away for a moment keeps its last state.
FileWatch::State FileWatch::look() const {
  State state;
  for (const auto& file : files_()) {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(file, error);
    const auto size = error ? 0 : std::filesystem::file_size(file, error);
    if (!error)
      state[file] = {time, size};
    else if (const auto it = last_.find(file); it != last_.end())
      state[file] = it->second;
    else
      state[file] = {};
  }
  return state;
}

bool FileWatch::changed() {
  State now = look();
  const bool changed = std::any_of(now.begin(), now.end(), [&](const auto& entry) {
    const auto it = last_.find(entry.first);
    return it != last_.end() && it->second != entry.second;
  });
  last_ = std::move(now);
  return changed;
}

}  // namespace papilla::app
