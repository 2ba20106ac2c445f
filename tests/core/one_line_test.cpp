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

TEST(Shown, EscapesWhatSteersATerminal) {
  EXPECT_EQ(shown("a\nb\r\tc"), "a\\nb\\r\\tc");
  EXPECT_EQ(shown("\x1b[2Jx\x7f"), "\\u001b[2Jx\\u007f");
  EXPECT_EQ(shown(std::string_view("x\0y", 3)), "x\\u0000y");
  EXPECT_EQ(shown("\xc2\x9b"
                  "31m"),
            "\\u009b31m");  // CSI as one character
  EXPECT_EQ(shown("gnp.\xe2\x80\xae"
                  "exe"),
            "gnp.\\u202eexe");                                     // right-to-left override
  EXPECT_EQ(shown("\xe2\x80\xa8\xe2\x81\xa6"), "\\u2028\\u2066");  // line separator, isolate
}

TEST(Shown, LeavesWrittenLanguageAlone) {
  for (const char* text : {"Türgriff – 3 mm", "内装", "דלת", "مقبض\u200cها", "👩\u200d🔧", "C:\\parts\\a b.png", ""})
    EXPECT_EQ(shown(text), text);
}

TEST(Shown, EscapesBytesThatAreNotUtf8) {
  EXPECT_EQ(shown("a\x9b"
                  "b"),
            "a\\x9bb");                                          // CSI of eight-bit terminals
  EXPECT_EQ(shown("\xc0\x9b"), "\\xc0\\x9b");                    // overlong
  EXPECT_EQ(shown("\xe2\x80"), "\\xe2\\x80");                    // cut
  EXPECT_EQ(shown("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // surrogate
  EXPECT_EQ(shown("\xf5\x80\x80\x80"), "\\xf5\\x80\\x80\\x80");  // beyond Unicode
}

TEST(Shown, LinesKeepTheirBreaks) {
  EXPECT_EQ(shown_lines("a\nb\x1b\n"), "a\nb\\u001b\n");
  EXPECT_EQ(shown_lines("{\n  \"a\": \"\xe2\x80\xae\"\n}"), "{\n  \"a\": \"\\u202e\"\n}");
}

}  // namespace
}  // namespace papilla
