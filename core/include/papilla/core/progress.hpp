// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "papilla/core/error.hpp"

namespace papilla {

/// How far long work is.
struct Progress {
  std::string_view stage;  ///< Its name, for people; valid during the call only.
  double fraction = 0;     ///< Of this stage, in [0, 1].
};

/// Called by long work, from one thread at a time, at most a few hundred times a stage. May be empty.
/// Returns false to cancel: the work then ends with Cancelled at its next report.
using ProgressCallback = std::function<bool(const Progress&)>;

/// Work was ended because its ProgressCallback returned false. Nothing was written.
class Cancelled : public Error {
 public:
  using Error::Error;
};

/// Calls `callback` unless it is empty.
/// @throws Cancelled when it returns false.
inline void report_progress(const ProgressCallback& callback, std::string_view stage, double fraction) {
  if (callback && !callback({stage, fraction})) throw Cancelled("cancelled during '" + std::string(stage) + "'");
}

/// One stage's progress, counted by several threads.
class SharedProgress {
 public:
  /// @param total What the amounts of add() come to in the end; > 0.
  SharedProgress(ProgressCallback callback, std::string stage, double total)
      : callback_(std::move(callback)), stage_(std::move(stage)), total_(total) {}

  /// @throws Cancelled as report_progress().
  void add(double amount) {
    if (!callback_) return;
    const std::scoped_lock lock(mutex_);
    done_ += amount;
    report_progress(callback_, stage_, std::min(1.0, done_ / total_));
  }

 private:
  ProgressCallback callback_;
  std::string stage_;
  double total_, done_ = 0;
  std::mutex mutex_;
};

}  // namespace papilla
