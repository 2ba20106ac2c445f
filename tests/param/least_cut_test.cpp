// SPDX-License-Identifier: MIT
#include "least_cut.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace papilla::param_detail {
namespace {

constexpr double k_never = std::numeric_limits<double>::infinity();

double cost(const std::vector<LabelCost>& items, const std::vector<LabelPair>& pairs, const std::vector<char>& second) {
  double sum = 0;
  for (std::size_t i = 0; i < items.size(); ++i) sum += second[i] ? items[i].second : items[i].first;
  for (const LabelPair& pair : pairs) sum += second[pair.a] != second[pair.b] ? pair.cost : 0;
  return sum;
}

TEST(LeastCut, IsTheLeastOfAllLabels) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1), positive(0, 1);
  for (int round = 0; round < 200; ++round) {
    const std::size_t count = 1 + random() % 9;
    std::vector<LabelCost> items;
    for (std::size_t i = 0; i < count; ++i) {
      const auto kind = random() % 4;
      items.push_back({kind == 0 ? k_never : any(random), kind == 1 ? k_never : any(random)});
    }
    std::vector<LabelPair> pairs;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a + 1; b < count; ++b)
        if (random() % 2) pairs.push_back({a, b, positive(random)});
    double least = k_never;
    for (std::size_t labels = 0; labels < std::size_t{1} << count; ++labels) {
      std::vector<char> second(count);
      for (std::size_t i = 0; i < count; ++i) second[i] = labels >> i & 1;
      least = std::min(least, cost(items, pairs, second));
    }
    EXPECT_NEAR(cost(items, pairs, least_cut(items, pairs)), least, 1e-12) << round;
  }
}

TEST(LeastCut, OfNothingIsNothing) { EXPECT_TRUE(least_cut({}, {}).empty()); }

}  // namespace
}  // namespace papilla::param_detail
