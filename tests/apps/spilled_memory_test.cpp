// SPDX-License-Identifier: GPL-3.0-or-later
#include "memory/spilled_memory.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <random>
#include <span>
#include <thread>
#include <vector>

namespace papilla::app {
namespace {

constexpr std::size_t k_mib = std::size_t{1} << 20;

std::size_t resident_bytes() {
  std::size_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// A block and what it was filled with.
struct Filled {
  std::span<std::uint64_t> words;
  std::uint64_t seed;

  Filled(void* block, std::size_t bytes, std::uint64_t s)
      : words(static_cast<std::uint64_t*>(block), bytes / sizeof(std::uint64_t)), seed(s) {
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = seed + 7 * i;
  }
  bool holds() const {
    for (std::size_t i = 0; i < words.size(); ++i)
      if (words[i] != seed + 7 * i) return false;
    return true;
  }
};

/// Lives until the program ends, as the one of the program does: pages are taken out by a thread that never ends.
SpilledMemory& spilled_from_the_start() {
  static auto* memory = new SpilledMemory({.begin_bytes = 0, .resident_bytes = 64 * k_mib, .least_block = 4096});
  return *memory;
}

TEST(SpilledMemory, NothingIsSpilledWhileMemoryIsNotShort) {
  SpilledMemory memory({.begin_bytes = SIZE_MAX / 2, .resident_bytes = SIZE_MAX / 2, .least_block = 4096});
  for (int i = 0; i < 100; ++i) EXPECT_EQ(memory.take(k_mib), nullptr);
  EXPECT_EQ(memory.file_bytes(), 0U);
  int on_stack = 0;
  EXPECT_FALSE(memory.owns(&on_stack));
  EXPECT_FALSE(memory.owns(nullptr));
}

TEST(SpilledMemory, WithoutAFolderThereIsNoBlock) {
  SpilledMemory memory({.begin_bytes = 0, .resident_bytes = 0, .least_block = 1, .folder = "/proc/no/folder"});
  EXPECT_EQ(memory.take(64 * k_mib), nullptr);
  EXPECT_EQ(memory.take(64 * k_mib), nullptr);
}

TEST(SpilledMemory, BlocksKeepTheirContentWhenTheirPagesLeave) {
  SpilledMemory& memory = spilled_from_the_start();
  const std::size_t before = resident_bytes();
  std::mt19937_64 random(1);
  std::vector<Filled> blocks;
  std::size_t sum = 0;
  for (int i = 0; sum < 700 * k_mib; ++i) {
    const std::size_t size = i % 50 == 7 ? 70 * k_mib : 8192 + random() % (2 * k_mib) / 16 * 16;
    void* block = memory.take(size);
    if (!block && blocks.empty()) continue;  // Looked at after some blocks.
    ASSERT_TRUE(block) << sum;
    EXPECT_TRUE(memory.owns(block));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 16, 0U);
    blocks.emplace_back(block, size, random());
    sum += size;
    if (i % 3 == 0) {  // Every third goes again.
      const std::size_t which = random() % blocks.size();
      EXPECT_TRUE(blocks[which].holds());
      sum -= blocks[which].words.size_bytes();
      memory.give(blocks[which].words.data());
      blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(which));
    }
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (resident_bytes() > before + 100 * k_mib && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  EXPECT_LT(resident_bytes(), before + 200 * k_mib);
  EXPECT_GE(memory.file_bytes(), sum);
  for (const Filled& block : blocks) EXPECT_TRUE(block.holds());
  for (const Filled& block : blocks) memory.give(block.words.data());
  EXPECT_LE(memory.file_bytes(), 64 * k_mib + k_mib);  // One empty heap is kept.
}

TEST(SpilledMemory, ThreadsShareIt) {
  SpilledMemory& memory = spilled_from_the_start();
  const auto work = [&](std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<Filled> blocks;
    for (int i = 0; i < 400; ++i) {
      const std::size_t size = 8192 + random() % (k_mib / 2) / 16 * 16;
      if (void* block = memory.take(size)) blocks.emplace_back(block, size, random());
      if (blocks.size() < 20) continue;
      EXPECT_TRUE(blocks.front().holds());
      memory.give(blocks.front().words.data());
      blocks.erase(blocks.begin());
    }
    EXPECT_FALSE(blocks.empty());
    for (const Filled& block : blocks) {
      EXPECT_TRUE(block.holds());
      memory.give(block.words.data());
    }
  };
  std::thread other(work, 2);
  work(3);
  other.join();
}

TEST(SpilledMemory, AForkedChildHasItsOwn) {
  SpilledMemory& memory = spilled_from_the_start();
  void* place = nullptr;
  while (!place) place = memory.take(k_mib);
  const Filled block(place, k_mib, 11);
  const pid_t child = ::fork();
  if (child == 0) {
    const bool holds = block.holds();
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    if (pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) > (std::size_t{4} << 30)) ::_exit(2);
    std::fill(block.words.begin(), block.words.end(), 0);
    memory.give(place);
    ::_exit(holds && memory.take(k_mib) == nullptr ? 0 : 1);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_TRUE(block.holds());
  memory.give(place);
}

}  // namespace
}  // namespace papilla::app
