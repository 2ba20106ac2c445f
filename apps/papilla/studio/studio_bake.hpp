// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "papilla/core/child_process.hpp"

namespace papilla::app {

/// Words of a command as a shell takes them, quoted where it needs that.
std::string shell_line(const std::vector<std::string>& words);

/// A bake of the studio: the very command line that is shown, in a process of its own. It is told how far it has come
/// and can be ended; what it has not finished is not written.
class StudioBake {
 public:
  struct News {
    enum class State { running, done, failed, cancelled } state = State::running;
    std::string stage;     ///< Of the bake.
    double fraction = 0;   ///< Of the stage.
    std::string messages;  ///< Of one that failed.
  };

  /// @param words of the command, "papilla" the first. @param tell called from a thread of its own; the last time with
  /// another state than running. @throws IoError.
  StudioBake(std::vector<std::string> words, std::function<void(const News&)> tell);
  ~StudioBake();  ///< Ends it and waits.
  StudioBake(const StudioBake&) = delete;
  StudioBake& operator=(const StudioBake&) = delete;

  void cancel() noexcept;
  bool is_running() const noexcept { return is_running_; }

 private:
  void follow();

  std::function<void(const News&)> tell_;
  ChildProcess child_;
  std::atomic<bool> is_cancelled_{false}, is_running_{true};
  std::thread thread_;
};

}  // namespace papilla::app
