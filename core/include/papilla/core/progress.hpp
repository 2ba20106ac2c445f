// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string_view>

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

}  // namespace papilla
