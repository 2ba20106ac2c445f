// SPDX-License-Identifier: MIT
#include "bench/evidence.hpp"

#include <gtest/gtest.h>

#include "bench/bench_json.hpp"

namespace papilla::bench {
namespace {

TEST(Evidence, PageHasTargetsRowsAndRatios) {
  BenchOptions options;
  options.repeats = 1;
  options.warm_up = 0;
  BenchReport report("demo", "Demonstration", options);
  report.add({.method = "fast", .input = "shape"}, [](Recorder& r) { r.record("steps", 2); });
  report.add({.method = "slow", .input = "shape"}, [](Recorder& r) { r.record("steps", 8); });
  report.compare("fast", "slow", "steps");
  report.measure();
  EXPECT_EQ(report.median_of("slow", "shape", "steps"), 8);
  EXPECT_THROW(report.median_of("slow", "other", "steps"), std::exception);
  report.target({"fast at most half of slow", "0.25", true});
  report.target({"a|b", "nothing", std::nullopt});
  report.target({"wrong", "1", false});
  report.table({"Shapes", "A note.", {"shape", "steps"}, {{"shape", "2"}}});

  const std::string page = report.evidence("./run bench demo");
  EXPECT_NE(page.find("# Demonstration: what was measured\n\nWritten by `./run bench demo`"), std::string::npos);
  EXPECT_NE(page.find("| fast at most half of slow | 0.25 | yes |\n"), std::string::npos);
  EXPECT_NE(page.find("| a\\|b | nothing | not measured |\n"), std::string::npos);
  EXPECT_NE(page.find("| wrong | 1 | **no** |\n"), std::string::npos);
  EXPECT_NE(page.find("## Shapes\n\nA note.\n\n| shape | steps |\n| --- | --- |\n| shape | 2 |\n"), std::string::npos);
  EXPECT_NE(page.find("| fast | slow | shape | steps | 0.25 | 0.25 to 0.25 |\n"), std::string::npos);
}

}  // namespace
}  // namespace papilla::bench
