// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress_printer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "json/json.hpp"
#include "papilla/core/one_line.hpp"

namespace papilla::app {
namespace {

constexpr std::chrono::milliseconds k_tick{500};
constexpr double k_least_pause_s = 0.1;  ///< Between two lines.
constexpr double k_quiet_s = 1;          ///< Shorter work shows nothing on a terminal.

/// Nobody is told of a standard error that can't be written: the work goes on.
void print(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

std::string duration(double seconds) {
  if (seconds < 60) return fmt::format("{:.0f} s", std::max(1.0, std::round(seconds)));
  return fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60), std::floor(std::fmod(seconds, 60)));
}

/// What is left of a stage at its pace so far, which falls while it says nothing. Negative: not known yet.
double seconds_left(double fraction, double spent) {
  constexpr double k_least_fraction = 0.01;
  return fraction > k_least_fraction && fraction < 1 ? spent * (1 - fraction) / fraction : -1;
}

}  // namespace

ProgressPrinter::ProgressPrinter(Form form) : form_(form), ticker_([this] { tick(); }) {}

ProgressPrinter::~ProgressPrinter() {
  {
    const std::scoped_lock lock(mutex_);
    end_ = true;
  }
  ended_.notify_one();
  ticker_.join();
  if (drawn_) print("\r\033[K");
}

void ProgressPrinter::tick() {
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, k_tick, [this] { return end_; })) draw();
}

void ProgressPrinter::report(std::string_view stage, double fraction) {
  const std::scoped_lock lock(mutex_);
  if (stage != stage_) {
    stage_ = stage;
    stage_clock_ = Stopwatch();
  }
  fraction_ = fraction;
  if (total_.seconds() - last_drawn_s_ >= k_least_pause_s || fraction >= 1) draw();
}

void ProgressPrinter::draw() {
  const double now = total_.seconds();
  if (form_ == Form::json) {
    const Json line{{"stage", stage_}, {"fraction", fraction_}, {"seconds", now}};
    print(shown(line.dump(-1, ' ', false, Json::error_handler_t::replace)) + "\n");
  } else {
    if (now < k_quiet_s) return;
    std::string line = fmt::format("{} {:3.0f} %  {}", shown(stage_), std::floor(100 * fraction_), duration(now));
    const double spent = stage_clock_.seconds();
    if (const double left = seconds_left(fraction_, spent); left > 0)
      line += fmt::format(", {:.2g} %/s, about {} left", 100 * fraction_ / spent, duration(left));
    print("\r\033[K" + line);
    drawn_ = true;
  }
  last_drawn_s_ = now;
}

}  // namespace papilla::app
