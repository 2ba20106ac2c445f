// SPDX-License-Identifier: MIT
#include "papilla/core/progress_until.hpp"

#include <gtest/gtest.h>

namespace papilla {
namespace {

TEST(ProgressUntil, EndsAtTheDeadline) {
  int told = 0;
  const ProgressCallback counts = [&](const Progress&) { return ++told < 3; };
  EXPECT_TRUE(progress_until(counts, Deadline())({"a", 0}));
  EXPECT_TRUE(progress_until(counts, Deadline(60))({"a", 0}));
  EXPECT_FALSE(progress_until(counts, Deadline(60))({"a", 0}));
  EXPECT_FALSE(progress_until({}, Deadline(-1))({"a", 0}));
  EXPECT_TRUE(progress_until({}, Deadline(60))({"a", 0}));
  EXPECT_FALSE(progress_until({}, Deadline()));
  EXPECT_EQ(told, 3);
}

}  // namespace
}  // namespace papilla
