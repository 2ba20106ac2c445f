// SPDX-License-Identifier: MIT
#include "papilla/study/balanced_order.hpp"

#include <gtest/gtest.h>

#include <map>
#include <utility>

namespace papilla {
namespace {

TEST(BalancedOrder, EveryConditionStandsAndFollowsEquallyOften) {
  for (const std::size_t n : {2U, 3U, 4U, 5U, 6U, 7U}) {
    const std::size_t rows = n % 2 == 0 ? n : 2 * n;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> at_place, follows;
    for (std::size_t row = 0; row < rows; ++row) {
      const std::vector<std::size_t> order = balanced_order(n, row);
      ASSERT_EQ(order.size(), n);
      for (std::size_t i = 0; i < n; ++i) {
        ++at_place[{i, order[i]}];
        if (i > 0) ++follows[{order[i - 1], order[i]}];
      }
    }
    ASSERT_EQ(at_place.size(), n * n) << n;
    for (const auto& [key, count] : at_place) EXPECT_EQ(count, rows / n) << n;
    ASSERT_EQ(follows.size(), n * (n - 1)) << n;
    for (const auto& [key, count] : follows) EXPECT_EQ(count, rows / n) << n;
  }
}

TEST(BalancedOrder, OfOneConditionAndOfNone) {
  EXPECT_EQ(balanced_order(1, 5), std::vector<std::size_t>{0});
  EXPECT_TRUE(balanced_order(0, 0).empty());
}

}  // namespace
}  // namespace papilla
