// SPDX-License-Identifier: MIT
#include "papilla/core/hex.hpp"

#include <gtest/gtest.h>

#include <array>

namespace papilla {
namespace {

TEST(Hex, TheHigherDigitFirst) {
  constexpr std::array<unsigned char, 5> bytes{0x00, 0x0f, 0xa5, 0xf0, 0x3c};
  EXPECT_EQ(hex_digits(bytes), "000fa5f03c");
  EXPECT_EQ(hex_digits({}), "");
}

}  // namespace
}  // namespace papilla
