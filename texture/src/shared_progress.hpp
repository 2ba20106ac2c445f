// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <string_view>

#include "papilla/core/progress.hpp"

namespace papilla::texture_detail {

/// Progress of work that several threads share, told one at a time.
class SharedProgress {
 public:
  SharedProgress(const ProgressCallback& progress, std::string_view stage, int parts)
      : progress_(progress), stage_(stage), parts_(parts) {}

  /// One more part is done.
  void step() {
    if (!progress_) return;
    const std::scoped_lock lock(mutex_);
    report_progress(progress_, stage_, static_cast<double>(++done_) / parts_);
  }

 private:
  const ProgressCallback& progress_;
  std::string_view stage_;
  int parts_, done_ = 0;
  std::mutex mutex_;
};

}  // namespace papilla::texture_detail
