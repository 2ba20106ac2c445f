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

TEST(OneLine, FirstLineEndsBeforeTheBreak) {
  EXPECT_EQ(first_line("one\ntwo"), "one");
  EXPECT_EQ(first_line("one"), "one");
  EXPECT_EQ(first_line("\ntwo"), "");
}

TEST(OneLine, PrintableQuotesTheBeginningInAscii) {
  EXPECT_EQ(printable("a\tb\x7f~"), "a?b?~");
  EXPECT_EQ(printable("\xc3\xbc"), "??");
  EXPECT_EQ(printable(std::string(50, 'x')), std::string(40, 'x'));
  EXPECT_EQ(printable("abc", 2), "ab");
}

}  // namespace
}  // namespace papilla
