// SPDX-License-Identifier: MIT
#pragma once

#include <thread>

#include "papilla/haptic/haptic_loop.hpp"

namespace papilla::player {

/// One line on stderr that shows what the loop does, five times a second, from a thread of its own. Without a terminal
/// there it does nothing.
class LiveView {
 public:
  explicit LiveView(const LoopStatus& status);
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

 private:
  std::jthread thread_;
};

}  // namespace papilla::player
