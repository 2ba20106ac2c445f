// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "papilla/core/trace.hpp"

namespace papilla::app {

/// Shows the progress of long work on one line of the terminal, or as one JSON object a line. What is shown moves every
/// second even when the work says nothing; the line is gone when the printer is.
class ProgressPrinter {
 public:
  enum class Form { line, json };

  explicit ProgressPrinter(Form form);
  ~ProgressPrinter();
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  void report(std::string_view stage, double fraction);

 private:
  void tick();
  void draw();

  const Form form_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false, drawn_ = false;
  std::string stage_ = "reading";
  double fraction_ = 0;
  Stopwatch total_, stage_clock_;
  double last_drawn_s_ = -1;
  std::thread ticker_;
};

}  // namespace papilla::app
