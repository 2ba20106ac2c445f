// SPDX-License-Identifier: MIT
#include "papilla/study/seeded_random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace papilla {
namespace {

TEST(SeededRandom, HasTheMomentsOfItsDistributions) {
  SeededRandom random(1);
  constexpr int n = 100000;
  double uniform = 0, normal = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    uniform += random.uniform();
    const double z = random.normal();
    normal += z;
    squares += z * z;
  }
  // Five standard errors.
  EXPECT_NEAR(uniform / n, 0.5, 5 / std::sqrt(12.0 * n));
  EXPECT_NEAR(normal / n, 0, 5 / std::sqrt(1.0 * n));
  EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2.0 / n));
}

TEST(SeededRandom, ShufflesToEveryOrderEquallyOften) {
  SeededRandom random(7);
  std::map<std::vector<int>, int> orders;
  constexpr int n = 24000;
  for (int i = 0; i < n; ++i) {
    std::vector<int> list = {1, 2, 3, 4};
    random.shuffle(list);
    ++orders[list];
  }
  ASSERT_EQ(orders.size(), 24U);
  for (const auto& [order, count] : orders) EXPECT_NEAR(count, 1000, 5 * std::sqrt(1000.0));
}

TEST(SeededRandom, StreamsAndSeedsDifferAndRepeat) {
  EXPECT_EQ(SeededRandom(1, 2).uniform(), SeededRandom(1, 2).uniform());
  EXPECT_NE(SeededRandom(1, 2).uniform(), SeededRandom(1, 3).uniform());
  EXPECT_NE(SeededRandom(1, 2).uniform(), SeededRandom(2, 1).uniform());
}

}  // namespace
}  // namespace papilla
