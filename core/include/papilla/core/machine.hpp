// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace papilla {

/// What a time was measured on. Fields that the system does not report are empty or 0.
struct Machine {
  std::string cpu;              ///< The processor's name.
  int cores = 0;                ///< Processors online.
  std::int64_t memory_mib = 0;  ///< Physical memory, rounded down.
  std::string kernel;           ///< Name and release.
};

/// Reads /proc and uname(). Never throws but for want of memory.
Machine this_machine();

/// The most memory that this process has had resident so far, in MiB; 0 where /proc does not report it.
double peak_rss_mib();

}  // namespace papilla
