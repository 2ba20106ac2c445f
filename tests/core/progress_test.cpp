// SPDX-License-Identifier: MIT
#include "papilla/core/progress.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

namespace papilla {
namespace {

TEST(Progress, ReportsStageAndFraction) {
  std::string stage;
  double fraction = 0;
  const ProgressCallback keep = [&](const Progress& progress) {
    stage = progress.stage;
    fraction = progress.fraction;
    return true;
  };
  report_progress(keep, "read", 0.25);
  EXPECT_EQ(stage, "read");
  EXPECT_EQ(fraction, 0.25);
  EXPECT_NO_THROW(report_progress({}, "read", 0.5));
}

TEST(Progress, FalseThrowsCancelledThatNamesTheStage) {
  try {
    report_progress([](const Progress&) { return false; }, "charts", 0);
    FAIL();
  } catch (const Cancelled& cancelled) {
    EXPECT_STREQ(cancelled.what(), "cancelled during 'charts'");
  }
}

TEST(SharedProgress, ThreadsReportOneAtATimeAndUpToOne) {
  int running = 0, reports = 0;
  bool overlap = false;
  std::vector<double> fractions;
  const ProgressCallback keep = [&](const Progress& progress) {
    overlap |= ++running > 1;
    ++reports;
    fractions.push_back(progress.fraction);
    --running;
    return true;
  };
  SharedProgress shared(keep, "work", 4000);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 1000; ++i) shared.add(1);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_FALSE(overlap);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1);
  EXPECT_GT(reports, 150);
  EXPECT_LE(reports, 250);
}

TEST(SharedProgress, CancelThrows) {
  const ProgressCallback cancel = [](const Progress&) { return false; };
  SharedProgress shared(cancel, "work", 10);
  EXPECT_THROW(shared.add(1), Cancelled);
  const ProgressCallback none;
  SharedProgress silent(none, "work", 10);
  EXPECT_NO_THROW(silent.add(1));
}

TEST(Progress, APieceOfAWorkHasItsRange) {
  std::vector<double> told;
  const ProgressCallback piece =
      progress_within([&](const Progress& done) { return told.push_back(done.fraction), true; }, 0.5, 0.75);
  piece({"map", 0});
  piece({"map", 0.5});
  piece({"map", 1});
  EXPECT_EQ(told, (std::vector<double>{0.5, 0.625, 0.75}));
  EXPECT_FALSE(progress_within({}, 0, 1));
}

TEST(WorkProgress, CountsEachFractionOnce) {
  double last = 0;
  SharedProgress all([&](const Progress& done) { return last = done.fraction, true; }, "work", 200);
  WorkProgress one(all, 100), other(all, 100);
  one.reach(0.5);
  EXPECT_EQ(last, 0.25);
  one.reach(0.25);  // Begun again.
  other.reach(0.5);
  EXPECT_EQ(last, 0.5);
  one.reach(1), other.reach(1);
  EXPECT_EQ(last, 1);
}

}  // namespace
}  // namespace papilla
