// SPDX-License-Identifier: GPL-3.0-or-later
// The operator new of the program papilla, which this test is linked with.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <random>
#include <thread>
#include <vector>

namespace {

constexpr std::size_t k_mib = std::size_t{1} << 20;

std::unique_ptr<std::byte[]> filled(std::size_t size, std::byte value) {
  std::unique_ptr<std::byte[]> block(new std::byte[size]);
  std::fill_n(block.get(), size, value);
  return block;
}

std::size_t resident_bytes() {
  std::size_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

bool is_resident(const std::byte* block, std::size_t size) {
  std::vector<unsigned char> pages(size / static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
  if (::mincore(const_cast<std::byte*>(block), size, pages.data()) != 0) return false;
  return std::all_of(pages.begin(), pages.end(), [](unsigned char page) { return page & 1; });
}

TEST(HugePages, LargeBlocksStartOnOne) {
  for (const std::size_t size : {4 * k_mib, 5 * k_mib + 1, 100 * k_mib}) {
    const std::unique_ptr<std::byte[]> block(new std::byte[size]);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block.get()) % (2 * k_mib), 0U) << size;
  }
}

TEST(HugePages, AFreedBlockIsHandedOutAgainWithItsPages) {
  constexpr std::size_t k_size = 12 * k_mib;
  filled(k_size, std::byte{1}).reset();
  const std::unique_ptr<std::byte[]> fresh(new std::byte[k_size * 2]);
  EXPECT_FALSE(is_resident(fresh.get(), k_size * 2));
  const std::unique_ptr<std::byte[]> again(new std::byte[k_size]);
  EXPECT_TRUE(is_resident(again.get(), k_size));
}

TEST(HugePages, ABlockMuchLargerThanWantedIsNotHandedOut) {
  filled(40 * k_mib, std::byte{1}).reset();
  const std::unique_ptr<std::byte[]> small(new std::byte[10 * k_mib]);
  EXPECT_FALSE(is_resident(small.get(), 10 * k_mib));
}

TEST(HugePages, WhatIsKeptIsBounded) {
  const std::size_t before = resident_bytes();
  std::vector<std::unique_ptr<std::byte[]>> blocks;
  for (int i = 0; i < 24; ++i) blocks.push_back(filled(16 * k_mib, std::byte{1}));
  blocks.push_back(filled(100 * k_mib, std::byte{1}));
  EXPECT_GT(resident_bytes(), before + 400 * k_mib);
  blocks.clear();
  EXPECT_LT(resident_bytes(), before + 80 * k_mib);
}

TEST(HugePages, NoTwoOwnersShareABlock) {
  constexpr int k_threads = 4, k_rounds = 400;
  std::array<int, k_threads> spoilt{};
  std::vector<std::thread> threads;
  for (int thread = 0; thread < k_threads; ++thread)
    threads.emplace_back([thread, &spoilt] {
      std::mt19937 random(static_cast<unsigned>(thread));
      struct Owned {
        std::unique_ptr<std::byte[]> bytes;
        std::size_t size;
        std::byte tag;
      };
      std::vector<Owned> owned;
      const auto check_and_free = [&](std::size_t i) {
        const Owned& block = owned[i];
        for (std::size_t at = 0; at < block.size; at += 4096)
          spoilt[static_cast<std::size_t>(thread)] += block.bytes[at] != block.tag;
        owned.erase(owned.begin() + static_cast<std::ptrdiff_t>(i));
      };
      for (int round = 0; round < k_rounds; ++round) {
        const std::size_t size = 3 * k_mib + random() % (9 * k_mib);
        const auto tag = static_cast<std::byte>(thread * 64 + round % 64);
        owned.push_back({std::unique_ptr<std::byte[]>(new std::byte[size]), size, tag});
        for (std::size_t at = 0; at < size; at += 4096) owned.back().bytes[at] = tag;
        if (owned.size() > 6) check_and_free(random() % owned.size());
      }
      while (!owned.empty()) check_and_free(0);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(spoilt, (std::array<int, k_threads>{}));
}

TEST(HugePages, AForkedChildHasBlocksWhateverOtherThreadsDo) {
  constexpr int k_children = 200, k_threads = 3;
  constexpr unsigned k_patience_s = 20;
  std::atomic<bool> ends = false;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < k_threads; ++thread)
    threads.emplace_back([&ends] {
      std::mt19937 random(1);
      while (!ends) {  // More than is kept: some of them go back to the system.
        std::vector<std::unique_ptr<std::byte[]>> blocks;
        for (int block = 0; block < 4; ++block)
          blocks.push_back(filled(9 * k_mib + random() % (20 * k_mib), std::byte{1}));
      }
    });
  int stuck = 0;
  for (int i = 0; i < k_children && stuck == 0; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::alarm(k_patience_s);  // Ends a child that waits for a thread of its parent.
      for (int block = 0; block < 3; ++block) filled(8 * k_mib, std::byte{1});
      ::_exit(0);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    stuck += !WIFEXITED(status);
  }
  ends = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(stuck, 0);
}

}  // namespace
