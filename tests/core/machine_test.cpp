// SPDX-License-Identifier: MIT
#include "papilla/core/machine.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace papilla {
namespace {

TEST(Machine, NamesProcessorsMemoryAndKernel) {
  const Machine machine = this_machine();
  EXPECT_GE(machine.cores, 1);
  EXPECT_EQ(machine.cores > 1, std::thread::hardware_concurrency() > 1);
  EXPECT_GT(machine.memory_mib, 64);
  EXPECT_EQ(machine.kernel.substr(0, 6), "Linux ");
}

TEST(Machine, PeakGrowsWithWhatIsTouched) {
  const double before = peak_rss_mib();
  std::vector<char> block(64U << 20U, 1);
  EXPECT_EQ(block.back(), 1);
  EXPECT_GT(peak_rss_mib(), before + 32);
}

}  // namespace
}  // namespace papilla
