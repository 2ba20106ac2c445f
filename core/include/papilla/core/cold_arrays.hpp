// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace papilla {

/// While one exists, the large arrays that are made wait for most of the time, as those of a scene of which one part
/// after the other is worked on. A program that keeps memory small may put them on disk; arrays that a solver goes
/// through again and again would cost it time there. Counts for the process, whatever the thread; may be nested.
class ColdArrays {
 public:
  ColdArrays() noexcept { count_.fetch_add(1, std::memory_order_relaxed); }
  ~ColdArrays() { count_.fetch_sub(1, std::memory_order_relaxed); }
  ColdArrays(const ColdArrays&) = delete;
  ColdArrays& operator=(const ColdArrays&) = delete;

  static bool any() noexcept { return count_.load(std::memory_order_relaxed) > 0; }

 private:
  static inline std::atomic<int> count_{0};
};

}  // namespace papilla
