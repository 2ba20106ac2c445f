// SPDX-License-Identifier: MIT
#include "papilla/io/picture_memory.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>

namespace papilla {
namespace {

std::atomic<std::uint64_t> g_bytes{0};

/// The limit in a file of the control group; the largest number there is when it has none or there is no such file.
std::uint64_t group_limit(const char* file) {
  std::uint64_t bytes = 0;
  std::ifstream in(file);
  return in >> bytes ? bytes : ~std::uint64_t{0};
}

std::uint64_t half_of_memory() {
  const std::uint64_t machine = static_cast<std::uint64_t>(std::max(1L, ::sysconf(_SC_PHYS_PAGES))) *
                                static_cast<std::uint64_t>(std::max(1L, ::sysconf(_SC_PAGESIZE)));
  return std::min({machine, group_limit("/sys/fs/cgroup/memory.max"),
                   group_limit("/sys/fs/cgroup/memory/memory.limit_in_bytes")}) /
         2;
}

}  // namespace

std::uint64_t picture_memory() noexcept {
  static const std::uint64_t half = half_of_memory();
  const std::uint64_t chosen = g_bytes;
  return chosen > 0 ? chosen : half;
}

void set_picture_memory(std::uint64_t bytes) noexcept { g_bytes = bytes; }

}  // namespace papilla
