// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/follow_files.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <system_error>
#include <thread>
#include <utility>

namespace papilla::app {
namespace {

using State = std::map<std::filesystem::path, std::pair<std::filesystem::file_time_type, std::uintmax_t>>;

/// A file that is away for a moment keeps its last state.
State state_of(const std::vector<std::filesystem::path>& files, const State& last) {
  State state;
  for (const auto& file : files) {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(file, error);
    const auto size = error ? 0 : std::filesystem::file_size(file, error);
    if (!error)
      state[file] = {time, size};
    else if (const auto it = last.find(file); it != last.end())
      state[file] = it->second;
    else
      state[file] = {};
  }
  return state;
}

/// Whether one of the files that were looked at before is another one now.
bool changed_since(const State& last, const State& now) {
  return std::any_of(now.begin(), now.end(), [&](const auto& entry) {
    const auto it = last.find(entry.first);
    return it != last.end() && it->second != entry.second;
  });
}

}  // namespace

void follow_files(const std::function<std::vector<std::filesystem::path>()>& files,
                  const std::function<void()>& changed, const std::function<bool()>& stopped) {
  State last = state_of(files(), {});
  while (!stopped()) {
    State now = state_of(files(), last);
    if (changed_since(last, now)) changed();
    last = std::move(now);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

}  // namespace papilla::app
