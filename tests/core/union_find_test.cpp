// SPDX-License-Identifier: MIT
#include "papilla/core/union_find.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace papilla {
namespace {

/// The number of its set for every element, sets joined by renaming.
class NaivePartition {
 public:
  explicit NaivePartition(std::size_t size) : set_(size) { std::iota(set_.begin(), set_.end(), 0U); }
  void unite(std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(set_[a], set_[b]);
    std::replace(set_.begin(), set_.end(), std::uint32_t{high}, std::uint32_t{low});
  }
  /// The smallest member of the set: the lower number survives every union.
  std::uint32_t find(std::uint32_t a) const { return set_[a]; }

 private:
  std::vector<std::uint32_t> set_;
};

TEST(UnionFind, RandomUnionsAgreeWithANaivePartition) {
  std::mt19937 random(3);
  UnionFind sets;
  for (const std::uint32_t size : {1U, 2U, 17U, 200U}) {
    sets.reset(size);
    ASSERT_EQ(sets.size(), size);
    NaivePartition expected(size);
    for (std::uint32_t k = 0; k < size; ++k) {
      const std::uint32_t a = random() % size, b = random() % size;
      sets.unite(a, b);
      expected.unite(a, b);
      for (std::uint32_t i = 0; i < size; ++i) ASSERT_EQ(sets.find(i), expected.find(i));
    }
  }
}

TEST(UnionFind, LabelsFollowTheSmallestMembers) {
  UnionFind sets(6);
  sets.unite(5, 1);
  sets.unite(4, 2);
  sets.unite(2, 4);
  std::uint32_t count = 0;
  EXPECT_EQ(sets.labels(count), (std::vector<std::uint32_t>{0, 1, 2, 3, 2, 1}));
  EXPECT_EQ(count, 4U);
}

TEST(UnionFind, TheOrderOfUnionsDoesNotMatter) {
  UnionFind one(100), other(100);
  for (std::uint32_t i = 0; i + 7 < 100; i += 3) one.unite(i, i + 7);
  for (std::uint32_t i = 90; i < 100; i -= 3) other.unite(i + 7, i);
  std::uint32_t one_count = 0, other_count = 0;
  EXPECT_EQ(one.labels(one_count), other.labels(other_count));
  EXPECT_EQ(one_count, other_count);
}

}  // namespace
}  // namespace papilla
