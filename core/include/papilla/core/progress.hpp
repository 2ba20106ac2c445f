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

/// State of a long computation.
struct Progress {
  std::string_view stage;  ///< Its name, for people; valid during the call only.
  double fraction = 0;     ///< Of this stage, in [0, 1].
};

/// Called by long computations, from one thread at a time, at most a few hundred times a stage. May be empty.
/// Returns false to cancel: the computation then throws Cancelled.
using ProgressCallback = std::function<bool(const Progress&)>;

/// A computation was ended because its ProgressCallback returned false. It has written nothing.
class Cancelled : public Error {
 public:
  using Error::Error;
};

/// Calls `callback` unless it is empty.
/// @throws Cancelled when it returns false.
inline void report_progress(const ProgressCallback& callback, std::string_view stage, double fraction) {
  if (callback && !callback({stage, fraction})) throw Cancelled("cancelled during '" + std::string(stage) + "'");
}

/// The fraction of a work that is a piece of another, from `begin` to `end` of it. Empty when the callback is.
inline ProgressCallback progress_within(ProgressCallback whole, double begin, double end) {
  if (!whole) return {};
  return [whole = std::move(whole), begin, end](const Progress& done) {
    return whole({done.stage, begin + (end - begin) * done.fraction});
  };
}

/// Reports the progress of a stage that several threads share: one report at a time, about 200 in all.
class SharedProgress {
 public:
  /// @param all  the work of the stage, in any unit.
  SharedProgress(ProgressCallback callback, std::string stage, double all)
      : callback_(std::move(callback)), stage_(std::move(stage)), all_(all) {}

  /// Counts work that is done.
  /// @throws Cancelled as report_progress().
  void add(double work) {
    if (!callback_ || !(work > 0)) return;
    const std::scoped_lock lock(mutex_);
    done_ += work;
    if (done_ < next_ && done_ < all_) return;
    next_ = done_ + all_ / k_reports;
    report_progress(callback_, stage_, std::min(1.0, done_ / all_));
  }

 private:
  static constexpr double k_reports = 200;
  ProgressCallback callback_;
  std::string stage_;
  double all_, done_ = 0, next_ = 0;
  std::mutex mutex_;
};

/// How far one of the works has come that a SharedProgress counts. Used by one thread at a time.
class WorkProgress {
 public:
  /// @param size  of the work, in the unit of `all`.
  WorkProgress(SharedProgress& all, double size) : all_(&all), size_(size) {}

  /// At least this fraction of the work is done.
  /// @throws Cancelled as report_progress().
  void reach(double fraction) {
    if (!(fraction > reached_)) return;
    const double more = fraction - reached_;
    reached_ = fraction;
    all_->add(more * size_);
  }

  /// Counts what a callback of the work is told.
  ProgressCallback callback() {
    return [this](const Progress& done) { return reach(done.fraction), true; };
  }

 private:
  SharedProgress* all_;
  double size_, reached_ = 0;
};

}  // namespace papilla
