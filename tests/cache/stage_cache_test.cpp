// SPDX-License-Identifier: MIT
#include "papilla/cache/stage_cache.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "papilla/core/temporary_folder.hpp"

namespace papilla {
namespace {

using Values = std::vector<std::string>;

TEST(StageCache, MakesOnceForTheSameInputs) {
  const TemporaryFolder folder("stage");
  int made = 0;
  const auto ask = [&](int input) {
    const StageCache cache{ContentStore(folder.path())};  // As another run would.
    return remembered(
        &cache, "values", CacheUse::read_write,
        [&] {
          return ++made, Values{"a", std::to_string(input)};
        },
        input);
  };
  EXPECT_FALSE(ask(1).found);
  EXPECT_TRUE(ask(1).found);
  EXPECT_EQ(ask(1).value, (Values{"a", "1"}));
  EXPECT_EQ(ask(2).value, (Values{"a", "2"}));
  EXPECT_EQ(made, 2);
}

TEST(StageCache, WithoutACacheEverythingIsMade) {
  int made = 0;
  for (int i = 0; i < 2; ++i)
    remembered(
        nullptr, "values", CacheUse::read_write, [&] { return ++made; }, 1);
  EXPECT_EQ(made, 2);
}

TEST(StageCache, WhatWasCutShortIsNotKept) {
  const TemporaryFolder folder("stage");
  const StageCache cache{ContentStore(folder.path())};
  int made = 0;
  const auto make = [&] { return ++made; };
  for (int i = 0; i < 2; ++i) remembered(&cache, "n", use_until(Deadline(1000)), make, 1);
  EXPECT_EQ(made, 2);
  for (int i = 0; i < 2; ++i) remembered(&cache, "n", use_until({}), make, 1);
  EXPECT_EQ(made, 3);
  EXPECT_TRUE(remembered(&cache, "n", use_until(Deadline(1000)), make, 1).found);
}

TEST(StageCache, AFailureIsNotKept) {
  const TemporaryFolder folder("stage");
  const StageCache cache{ContentStore(folder.path())};
  const auto fail = []() -> int { throw std::runtime_error("no"); };
  EXPECT_THROW(remembered(&cache, "n", CacheUse::read_write, fail, 1), std::runtime_error);
  EXPECT_FALSE(remembered(
                   &cache, "n", CacheUse::read_write, [] { return 5; }, 1)
                   .found);
}

TEST(StageCache, AnEntryOfAnotherShapeIsMadeAnew) {
  const TemporaryFolder folder("stage");
  const StageCache cache{ContentStore(folder.path())};
  const Digest key = key_of("n", 1);
  cache.put("n", key, CacheUse::read_write, std::string("long enough to be no list of numbers"));
  EXPECT_EQ(cache.find<std::vector<double>>("n", key), std::nullopt);
  EXPECT_FALSE(cache.store().contains("n", key));
}

TEST(StageCache, Counts) {
  const TemporaryFolder folder("stage");
  const StageCache cache{ContentStore(folder.path())};
  for (const int input : {1, 2, 1, 1})
    remembered(
        &cache, "n", CacheUse::read_write, [&] { return input; }, input);
  const CacheCount count = cache.counts().at("n");
  EXPECT_EQ(count.found, 2u);
  EXPECT_EQ(count.made, 2u);
  EXPECT_EQ(count.bytes_read, 2 * sizeof(int));
  EXPECT_EQ(count.bytes_written, 2 * (sizeof(int) + 48));
}

TEST(StageCache, TakesOverFromASharedCacheAndHandsOn) {
  const TemporaryFolder folder("stage");
  const ContentStore others(folder.path() / "others");
  const auto ask = [&](const char* own, int input, const StageCache* shared) {
    const StageCache cache(ContentStore(folder.path() / own), shared);
    remembered(
        &cache, "n", CacheUse::read_write, [&] { return input; }, input);
    cache.report_to_shared();
    return cache.counts().at("n");
  };
  const StageCache first(others), second(others);
  EXPECT_EQ(ask("a", 1, &first).made, 1u);  // Into both.
  EXPECT_EQ(first.counts().at("n").made, 1u);
  EXPECT_EQ(first.counts().at("n").bytes_written, sizeof(int) + 48);
  const CacheCount taken = ask("b", 1, &second);
  EXPECT_EQ(taken.found, 1u);
  EXPECT_EQ(taken.taken, 1u);
  EXPECT_EQ(second.counts().at("n").found, 1u);
  EXPECT_EQ(second.counts().at("n").bytes_read, sizeof(int));
  EXPECT_EQ(ask("b", 1, nullptr).found, 1u);  // Its own by now, whatever becomes of the shared one.
  EXPECT_EQ(ask("b", 1, &second).taken, 0u);
  EXPECT_EQ(second.counts().at("n").found, 1u);
}

TEST(StageCache, AChildHasTheSameStoresAndCountsByItself) {
  const TemporaryFolder folder("stage");
  const StageCache shared{ContentStore(folder.path() / "shared")};
  const StageCache own(ContentStore(folder.path() / "own"), &shared);
  const auto child = own.for_child(), alone = shared.for_child();
  shared.put("n", key_of("n", 1), CacheUse::read_write, 7);
  EXPECT_EQ(child->find<int>("n", key_of("n", 1)), 7);
  child->put("n", key_of("n", 2), CacheUse::read_write, 8);
  EXPECT_EQ(alone->find<int>("n", key_of("n", 2)), 8);
  const CacheCount count = child->counts().at("n");
  EXPECT_EQ(count.taken, 1u);
  EXPECT_EQ(count.made, 1u);
  EXPECT_TRUE(own.counts().empty());
}

TEST(StageCache, ASharedCacheThatIsDamagedOrRefusesCostsNoResult) {
  const TemporaryFolder folder("stage");
  const StageCache shared{ContentStore(folder.path() / "shared")};
  const Digest key = key_of("n", 1);
  shared.put("n", key, CacheUse::read_write, 7);
  std::filesystem::resize_file(shared.store().path_of("n", key), 50);
  const StageCache own(ContentStore(folder.path() / "own"), &shared);
  EXPECT_EQ(own.find<int>("n", key), std::nullopt);
  EXPECT_FALSE(shared.store().contains("n", key));

  std::ofstream(folder.path() / "file") << "x";
  const StageCache none{ContentStore(folder.path() / "file")};
  const StageCache over_none(ContentStore(folder.path() / "over_none"), &none);
  over_none.put("n", key, CacheUse::read_write, 7);
  EXPECT_EQ(over_none.find<int>("n", key), 7);
  EXPECT_EQ(over_none.problem(), "");
  EXPECT_NE(none.problem().find("file"), std::string::npos);
}

TEST(StageCache, AStoreThatRefusesIsAProblemAndNoError) {
  const TemporaryFolder folder("stage");
  std::ofstream(folder.path() / "file") << "x";
  const StageCache cache{ContentStore(folder.path() / "file")};
  EXPECT_EQ(remembered(
                &cache, "n", CacheUse::read_write, [] { return 5; }, 1)
                .value,
            5);
  EXPECT_NE(cache.problem().find("file"), std::string::npos);
  EXPECT_EQ(cache.counts().at("n").bytes_written, 0u);
}

}  // namespace
}  // namespace papilla
