// SPDX-License-Identifier: MIT
#include "papilla/cache/stage_key.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace papilla {
namespace {

struct Options {
  double length = 1;
  int rounds = 3;
  std::function<void()> told;
  Deadline deadline;
  const int* memory = nullptr;
};

TEST(Sha256, VectorsOfTheStandard) {
  EXPECT_EQ(to_hex(sha256("abc", 3)), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  Sha256 pieces;
  const std::string thousand(1000, 'a');
  for (int i = 0; i < 1000; ++i) pieces.write(thousand.data(), thousand.size());
  EXPECT_EQ(to_hex(pieces.finish()), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(StageKey, IsOfStageInputsAndOptions) {
  const Digest key = key_of("stage", Options{}, 5);
  EXPECT_EQ(key_of("stage", Options{}, 5), key);
  EXPECT_NE(key_of("other", Options{}, 5), key);
  EXPECT_NE(key_of("stages", Options{}, 5), key);
  EXPECT_NE(key_of("s", Options{}, 5), key);
  EXPECT_NE(key_of("stage", Options{}, 6), key);
  EXPECT_NE(key_of("stage", Options{.length = 2}, 5), key);
  EXPECT_NE(key_of("stage", Options{.rounds = 4}, 5), key);
}

TEST(StageKey, LeavesOutWhatDoesNotChangeACompleteResult) {
  const int number = 1;
  Options options;
  options.told = [] {};
  options.deadline = Deadline(5);
  options.memory = &number;
  EXPECT_EQ(key_of("stage", options), key_of("stage", Options{}));
}

TEST(StageKey, TellsZeroesApart) { EXPECT_NE(key_of("stage", 0.0), key_of("stage", -0.0)); }

}  // namespace
}  // namespace papilla
