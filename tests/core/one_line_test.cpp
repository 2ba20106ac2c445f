// SPDX-License-Identifier: MIT
#include "papilla/core/one_line.hpp"

#include <gtest/gtest.h>

namespace papilla {
namespace {

TEST(OneLine, ControlCharactersBecomeBlanks) {
  EXPECT_EQ(one_line("a\nb\r\tc"), "a b  c");
  EXPECT_EQ(one_line(std::string_view("x\0y", 3)), "x y");
  EXPECT_EQ(one_line("Türgriff – 3 mm"), "Türgriff – 3 mm");  // bytes above 127 stay
  EXPECT_EQ(one_line(""), "");
}

}  // namespace
}  // namespace papilla
