// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "batch/batch_line.hpp"
#include "papilla/core/deadline.hpp"

namespace papilla::app {

struct BatchOptions {
  int jobs = 1;     ///< Processes side by side.
  int threads = 1;  ///< Of each whose line does not say it.
  bool skip_existing = false, keep_going = false;
  Deadline deadline;
};

/// What became of a line.
struct LineResult {
  enum class State {
    not_run,  ///< The batch ended before.
    done,
    skipped,  ///< Its outputs were there.
    failed,
    ended  ///< With the batch, by a signal.
  } state = State::not_run;
  int exit_code = 0;  ///< As shells have it.
  double seconds = 0, cpu_seconds = 0, peak_mib = 0;
  std::string messages;  ///< Standard error of one that failed.
};

struct BatchResult {
  std::vector<LineResult> lines;  ///< In the order of the lines.
  int signal = 0;                 ///< SIGINT, SIGTERM or SIGHUP that ended it; 0: none.
  bool timed_out = false;
};

/// Runs every line as a process of this program. When all lines have a cost, the longest begin first; else they begin
/// in their order. A line that fails lets those end that run, and no other begins unless `keep_going`. SIGINT, SIGTERM,
/// SIGHUP and the deadline end those that run, and are waited for.
/// @param on_end Called from the calling thread for every line that ended or is skipped; may throw, which ends all.
BatchResult run_batch(std::span<const BatchLine> lines, const BatchOptions& options,
                      const std::function<void(std::size_t line, const LineResult&)>& on_end);

}  // namespace papilla::app
