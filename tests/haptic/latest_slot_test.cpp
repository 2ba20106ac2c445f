// SPDX-License-Identifier: MIT
#include "papilla/haptic/latest_slot.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace papilla {
namespace {

struct Many {
  std::uint32_t of[27] = {};  // 108 bytes: no whole number of words.
};

Many all(std::uint32_t value) {
  Many many;
  for (std::uint32_t& one : many.of) one = value;
  return many;
}

TEST(LatestSlot, TheNewestWins) {
  LatestSlot<Many> slot;
  Many seen = all(7);
  EXPECT_EQ(slot.load(seen), 0U);
  EXPECT_EQ(seen.of[0], 7U);
  slot.store(all(1));
  slot.store(all(2));
  EXPECT_EQ(slot.load(seen), 2U);
  EXPECT_EQ(seen.of[0], 2U);
  EXPECT_EQ(seen.of[26], 2U);
}

TEST(LatestSlot, NeverPartsOfTwo) {
  LatestSlot<Many> slot;
  constexpr std::uint32_t k_last = 200000;
  std::vector<std::thread> readers;
  std::atomic<int> torn{0}, backwards{0};
  for (int i = 0; i < 2; ++i)
    readers.emplace_back([&] {
      std::uint64_t before = 0;
      for (Many seen; before < k_last;) {
        const std::uint64_t number = slot.load(seen);
        if (number < before) ++backwards;
        before = number;
        for (const std::uint32_t one : seen.of)
          if (one != number) ++torn;
      }
    });
  for (std::uint32_t i = 1; i <= k_last; ++i) slot.store(all(i));
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(backwards, 0);
}

}  // namespace
}  // namespace papilla
