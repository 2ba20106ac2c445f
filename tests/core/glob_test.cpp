// SPDX-License-Identifier: MIT
#include "papilla/core/glob.hpp"

#include <gtest/gtest.h>

#include <string>

namespace papilla {
namespace {

TEST(Glob, CoversTheWholeName) {
  EXPECT_TRUE(matches_glob("dash*", "dash_skin"));
  EXPECT_TRUE(matches_glob("dash_?[0-9]", "dash_a3"));
  EXPECT_FALSE(matches_glob("dash", "dash_skin"));
  EXPECT_FALSE(matches_glob("Dash*", "dash_skin"));
  EXPECT_TRUE(matches_glob("a\\*", "a*"));
  EXPECT_FALSE(matches_glob("a\\*", "ab"));
}

TEST(Glob, OfANameTakesSlashesAsLetters) { EXPECT_TRUE(matches_glob("seat*", "seat/body 1")); }

TEST(Glob, QuestionMarkIsACharacterOfUtf8) {
  EXPECT_TRUE(matches_glob("T?r", "Tür"));
  EXPECT_FALSE(matches_glob("T?r", "Türr"));
  EXPECT_TRUE(matches_glob("[äöü]ber*", "über uns"));
  EXPECT_TRUE(matches_path_glob("**/T?r", "Haus/Tür"));
}

TEST(Glob, BytesThatAreNoUtf8FitAsTheyAre) {
  EXPECT_TRUE(matches_glob("T*", "T\xfcr"));
  EXPECT_TRUE(matches_glob("T\xfcr", "T\xfcr"));
  EXPECT_FALSE(matches_glob("Tur", "T\xfcr"));
}

TEST(Glob, ANullByteFitsNothing) {
  EXPECT_FALSE(matches_glob("a", std::string("a\0b", 3)));
  EXPECT_FALSE(matches_glob(std::string("a\0b", 3), "a"));
  EXPECT_FALSE(matches_path_glob("a", std::string("a\0b", 3)));
}

TEST(PathGlob, StarStaysWithinAName) {
  EXPECT_TRUE(matches_path_glob("cockpit/seat*/cushion", "cockpit/seat_left/cushion"));
  EXPECT_FALSE(matches_path_glob("cockpit/seat*/cushion", "cockpit/seat/left/cushion"));
  EXPECT_FALSE(matches_path_glob("cockpit/*", "cockpit"));
  EXPECT_FALSE(matches_path_glob("*", "cockpit/seat"));
}

TEST(PathGlob, TwoStarsAreAnyNumberOfNames) {
  for (const char* path : {"a/c", "a/b/c", "a/b/b/c"}) EXPECT_TRUE(matches_path_glob("a/**/c", path)) << path;
  EXPECT_TRUE(matches_path_glob("**", "a/b/c"));
  EXPECT_TRUE(matches_path_glob("**/c", "c"));
  EXPECT_TRUE(matches_path_glob("a/**", "a"));
  EXPECT_TRUE(matches_path_glob("**/b/**/c*", "a/b/x/y/cushion"));
  EXPECT_FALSE(matches_path_glob("a/**/c", "b/a/c"));
  EXPECT_FALSE(matches_path_glob("a/**/c", "a/b/c/d"));
}

}  // namespace
}  // namespace papilla
