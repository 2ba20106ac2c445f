// SPDX-License-Identifier: MIT
#include "papilla/core/deadline.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace papilla {
namespace {

TEST(Deadline, NeverComesUnlessSecondsAreGiven) {
  EXPECT_TRUE(Deadline().never());
  EXPECT_FALSE(Deadline().passed());
  EXPECT_EQ(Deadline().left(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(Deadline().earlier_by(1e9).never());
  EXPECT_TRUE(Deadline(std::numeric_limits<double>::infinity()).never());
}

TEST(Deadline, PassesAfterItsSeconds) {
  EXPECT_TRUE(Deadline(0).passed());
  EXPECT_TRUE(Deadline(-1).passed());
  const Deadline hour(3600);
  EXPECT_FALSE(hour.passed());
  EXPECT_NEAR(hour.left(), 3600, 60);
  EXPECT_NEAR(hour.earlier_by(600).left(), 3000, 60);
  EXPECT_TRUE(hour.earlier_by(3601).passed());
}

}  // namespace
}  // namespace papilla
