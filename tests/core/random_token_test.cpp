// SPDX-License-Identifier: MIT
#include "papilla/core/random_token.hpp"

#include <gtest/gtest.h>

#include <set>

namespace papilla {
namespace {

TEST(RandomToken, ThirtyTwoDigitsAndNeverTheSame) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 2 * k_random_token_bytes);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
    EXPECT_TRUE(seen.insert(token).second) << token;
  }
}

}  // namespace
}  // namespace papilla
