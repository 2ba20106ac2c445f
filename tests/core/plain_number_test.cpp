// SPDX-License-Identifier: MIT
#include "papilla/core/plain_number.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace papilla {
namespace {

TEST(PlainNumber, HasNoExponentWherePeopleWriteNone) {
  EXPECT_EQ(plain_number(1e-6), "0.000001");
  EXPECT_EQ(plain_number(1e6), "1000000");
  EXPECT_EQ(plain_number(1e12), "1000000000000");
  EXPECT_EQ(plain_number(0.1), "0.1");
  EXPECT_EQ(plain_number(-2.5), "-2.5");
  EXPECT_EQ(plain_number(0), "0");
}

TEST(PlainNumber, HasAnExponentBeyond) {
  EXPECT_EQ(plain_number(1e-7), "1e-07");
  EXPECT_EQ(plain_number(1e13), "1e+13");
}

TEST(PlainNumber, NamesWhatIsNoNumber) {
  EXPECT_EQ(plain_number(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(plain_number(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(plain_number(std::numeric_limits<double>::quiet_NaN()), "nan");
}

}  // namespace
}  // namespace papilla
