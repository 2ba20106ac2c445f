// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "papilla/core/child_process.hpp"

namespace papilla::app {

/// Plays one stimulus at a time by running papilla-player, that beside this program or else the first in PATH. Its
/// functions may be called from any thread.
class StimulusPlayer {
 public:
  /// @param device  as papilla-player takes it; empty: nothing is played, people run the command themselves.
  StimulusPlayer(std::string device, double seconds) : device_(std::move(device)), seconds_(seconds) {}
  ~StimulusPlayer() { stop(); }
  StimulusPlayer(const StimulusPlayer&) = delete;
  StimulusPlayer& operator=(const StimulusPlayer&) = delete;

  bool plays() const noexcept { return !device_.empty(); }
  /// The command line that plays a file, for people.
  std::string command(const std::filesystem::path& file) const;
  /// Begins to play; what was playing ends. @throws DeviceError when the player can't be started.
  void start(const std::filesystem::path& file);
  /// Whether it is still playing.
  bool is_playing();
  /// Waits for the end. @returns why it failed; empty when it did not.
  std::string wait();
  void stop();
  /// Why the last one failed; empty when it did not, or was stopped.
  std::string failure();

 private:
  /// Waits for its end, and keeps why it failed.
  void finish();

  std::string device_;
  double seconds_;
  std::mutex mutex_;
  std::optional<ChildProcess> child_;
  std::string failure_;
};

}  // namespace papilla::app
