// SPDX-License-Identifier: MIT
#include "papilla/haptic/loop_clock.hpp"

#include <time.h>

#include <cerrno>
#include <cmath>

namespace papilla {

double LoopClock::now_s() noexcept {
  timespec t{};
  clock_gettime(CLOCK_BOOTTIME, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void LoopClock::sleep_until(double time_s) noexcept {
  const double whole = std::floor(time_s);
  timespec t{};
  t.tv_sec = static_cast<time_t>(whole);
  t.tv_nsec = static_cast<long>(1e9 * (time_s - whole));
  while (clock_nanosleep(CLOCK_BOOTTIME, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

}  // namespace papilla
