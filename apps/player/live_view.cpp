// SPDX-License-Identifier: MIT
#include "live_view.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>

namespace papilla::player {
namespace {

void show(const LoopStatus& s) {
  fmt::print(
      stderr,
      "\r\033[K{} ticks, force {:.2f} N, contact on {}, lost on {}, late on {}, tick {:.1f} us, wake-up {:.0f} us",
      s.ticks.load(), s.force_n.load(), s.contact_ticks.load(), s.lost_contact_ticks.load(), s.missed_deadlines.load(),
      s.tick_us.load(), s.wakeup_us.load());
  std::fflush(stderr);
}

}  // namespace

LiveView::LiveView(const LoopStatus& status) {
  if (::isatty(STDERR_FILENO) == 0) return;
  thread_ = std::jthread([&status](const std::stop_token& end) {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    while (!wake.wait_for(lock, end, std::chrono::milliseconds(200), [&] { return end.stop_requested(); }))
      show(status);
    show(status);
    std::fputc('\n', stderr);
  });
}

LiveView::~LiveView() = default;

}  // namespace papilla::player
