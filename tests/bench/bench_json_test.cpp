// SPDX-License-Identifier: MIT
#include "bench/bench_json.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "papilla/core/error.hpp"

namespace papilla::bench {
namespace {

/// Uses processor time without sleeping.
double spin(double cpu_seconds) {
  const double end = thread_cpu_seconds() + cpu_seconds;
  double sum = 0;
  for (int i = 0; thread_cpu_seconds() < end; ++i) sum += std::sin(i);
  return sum;
}

BenchOptions few(int repeats, int warm_up = 0) {
  BenchOptions options;
  options.repeats = repeats;
  options.warm_up = warm_up;
  return options;
}

TEST(BenchJson, Median) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(median({7}), 7);
  EXPECT_THROW(median({}), InvalidInput);
}

TEST(BenchJson, ProcessorClocksCountWorkOfThisThread) {
  const double thread_before = thread_cpu_seconds(), process_before = process_cpu_seconds();
  keep(spin(0.01));
  EXPECT_GE(thread_cpu_seconds() - thread_before, 0.01);
  EXPECT_GE(process_cpu_seconds() - process_before, 0.0099);
}

TEST(BenchJson, LeastProcessorTimeOfSomeRuns) {
  int runs = 0;
  const double least = cpu_of(3, [&] { keep(spin(++runs == 2 ? 0.2 : 0.3)); });
  EXPECT_EQ(runs, 3);  // 0.8 s: enough
  EXPECT_GE(least, 0.199);
  EXPECT_LT(least, 0.3);
  runs = 0;
  cpu_of(2, [&] { keep(spin(0.05)), ++runs; });
  EXPECT_GE(runs, 9);  // half a second
  runs = 0;
  cpu_of(1, [&] { ++runs; });
  EXPECT_EQ(runs, 1);
}

TEST(BenchJson, PeakMemoryRisesAndCanBeReset) {
  reset_peak_rss();
  const double before = peak_rss_mib();
  ASSERT_GT(before, 0);
  // Not from the heap, which may keep what is freed.
  constexpr std::size_t k_bytes = 64U << 20;
  void* block = ::mmap(nullptr, k_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
  ASSERT_NE(block, MAP_FAILED);
  ::munmap(block, k_bytes);
  EXPECT_GT(peak_rss_mib(), before + 60);
  reset_peak_rss();
  EXPECT_LT(peak_rss_mib(), before + 30);
}

TEST(BenchJson, RunsGoInTurnsAfterTheWarmUp) {
  BenchReport report("order", "", few(2, 1));
  std::string order;
  report.add({.method = "a"}, [&](Recorder&) { order += 'a'; });
  report.add({.method = "b"}, [&](Recorder&) { order += 'b'; });
  report.measure();
  EXPECT_EQ(order, "ababab");
  EXPECT_EQ(report.json()["runs"][0]["repeats"]["seconds"].size(), 2U);
}

TEST(BenchJson, SaysWhereItRan) {
  BenchReport report("where", "A summary", few(3));
  const Json& json = report.json();
  EXPECT_EQ(json["benchmark"], "where");
  EXPECT_EQ(json["repeats"], 3);
  EXPECT_EQ(json["version"], version());
  EXPECT_GE(json["machine"]["cores"], 1);
  EXPECT_GE(json["threads"], 1);
  for (const char* key : {"commit", "started"}) EXPECT_FALSE(json[key].get<std::string>().empty()) << key;
  for (const char* key : {"name", "version", "build_type"})
    EXPECT_FALSE(json["compiler"][key].get<std::string>().empty()) << key;
}

TEST(BenchJson, KeepsEveryRepeatItsMedianTraceAndStop) {
  BenchReport report("values", "", few(3));
  int repeat = 0;
  report.add({.method = "m", .solver = "s", .input = "i", .options = {{"phi", 0.5}}, .error_name = "energy"},
             [&](Recorder& recorder) {
               recorder.record("stretch", std::array{5.0, 1.0, 3.0}.at(static_cast<std::size_t>(repeat++)));
               recorder.trace({{0.1, 9}, {0.2, repeat * 1.0}});
               recorder.stop(StopReason::iteration_limit);
             });
  report.measure();
  const Json& run = report.json()["runs"][0];
  EXPECT_EQ(run["repeats"]["stretch"], (Json{5.0, 1.0, 3.0}));
  EXPECT_EQ(run["median"]["stretch"], 3.0);
  EXPECT_EQ(run["trace"], (Json::array({{{"seconds", 0.1}, {"error", 9.0}}, {{"seconds", 0.2}, {"error", 3.0}}})));
  EXPECT_EQ(run["stop"], "iteration_limit");
  EXPECT_EQ(run["solver"], "s");
  EXPECT_EQ(run["options"]["phi"], 0.5);
  EXPECT_EQ(run["error_name"], "energy");
}

TEST(BenchJson, TimesOnlyThePartAskedFor) {
  BenchReport report("part", "", few(1));
  report.add({.method = "part"}, [](Recorder& recorder) {
    keep(spin(0.05));
    for (int i = 0; i < 2; ++i) recorder.time([] { keep(spin(0.005)); });
  });
  report.add({.method = "whole"}, [](Recorder&) { keep(spin(0.05)); });
  report.measure();
  const double part = report.json()["runs"][0]["median"]["cpu_seconds"];
  EXPECT_GE(part, 0.0099);
  EXPECT_LT(part, 0.04);
  EXPECT_GE(report.json()["runs"][1]["median"]["cpu_seconds"], 0.0499);
}

TEST(BenchJson, RatiosArePairedByInput) {
  BenchReport report("ratio", "", few(2));
  std::vector<double> own = {2, 6}, peer = {4, 3};
  const auto record = [](std::vector<double>& left) {
    return [&left](Recorder& recorder) {
      recorder.record("error", left.front());
      left.erase(left.begin());
    };
  };
  report.add({.method = "own", .input = "x"}, record(own));
  report.add({.method = "peer", .solver = "cgal", .input = "x"}, record(peer));
  report.add({.method = "own", .input = "y"}, [](Recorder& recorder) { recorder.record("error", 1); });
  report.compare("own", "peer/cgal", "error");
  report.measure();
  const Json& ratios = report.json()["ratios"];
  ASSERT_EQ(ratios.size(), 1U);
  EXPECT_EQ(ratios[0]["input"], "x");
  EXPECT_DOUBLE_EQ(ratios[0]["ratio"], 4 / 3.5);
  EXPECT_DOUBLE_EQ(ratios[0]["low"], 0.5);
  EXPECT_DOUBLE_EQ(ratios[0]["high"], 2);
  EXPECT_NE(report.table().find("own / peer/cgal on x: error = 1.1429 (0.5 to 2)"), std::string::npos)
      << report.table();
}

TEST(BenchJson, RefusesWhatCannotBeReported) {
  BenchReport nothing("none", "", few(1));
  nothing.add({.method = "a"}, [](Recorder&) {});
  nothing.compare("a", "missing");
  EXPECT_THROW(nothing.measure(), InvalidInput);

  BenchReport not_a_number("nan", "", few(1));
  not_a_number.add({.method = "a"},
                   [](Recorder& recorder) { recorder.record("x", std::numeric_limits<double>::quiet_NaN()); });
  EXPECT_THROW(not_a_number.measure(), InvalidInput);

  BenchReport twice("twice", "", few(1));
  twice.add({.method = "a"}, [](Recorder& recorder) {
    recorder.record("x", 1);
    recorder.record("x", 2);
  });
  EXPECT_THROW(twice.measure(), InvalidInput);

  BenchReport changing("changing", "", few(2));
  changing.add({.method = "a"}, [first = true](Recorder& recorder) mutable {
    recorder.record(first ? "x" : "y", 1);
    first = false;
  });
  EXPECT_THROW(changing.measure(), InvalidInput);
}

int run(std::vector<std::string> arguments, const std::function<void(BenchReport&)>& body) {
  arguments.insert(arguments.begin(), "papilla-bench-self");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = run_benchmark("self", "Self-test", static_cast<int>(argv.size()), argv.data(), body);
  testing::internal::GetCapturedStdout();
  testing::internal::GetCapturedStderr();
  return code;
}

TEST(BenchJson, TheProgramWritesItsReport) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("papilla-bench-" + std::to_string(::getpid()) + ".json");
  const auto body = [](BenchReport& report) {
    EXPECT_TRUE(report.options().quick);
    EXPECT_EQ(report.options().inputs, std::vector<std::string>{"a.step"});
    report.add({.method = "a"}, [](Recorder&) {});
    report.measure();
  };
  EXPECT_EQ(run({"--json", file, "--repeats", "4", "--threads", "1", "--quick", "a.step"}, body), 0);
  const Json json = Json::parse(std::ifstream(file));
  std::filesystem::remove(file);
  EXPECT_EQ(json["benchmark"], "self");
  EXPECT_EQ(json["threads"], 1);
  EXPECT_EQ(json["runs"][0]["repeats"]["seconds"].size(), 4U);
}

TEST(BenchJson, TheProgramTellsWrongUsageFromWrongInput) {
  EXPECT_EQ(run({"--repeats", "0"}, [](BenchReport&) {}), 2);
  EXPECT_EQ(run({"--help"}, [](BenchReport&) {}), 0);
  EXPECT_EQ(run({}, [](BenchReport&) { throw IoError("a.step: is missing"); }), 3);
  EXPECT_EQ(run({}, [](BenchReport&) {}), 3) << "nothing was measured";
  EXPECT_EQ(run({"--json", "/missing/folder/a.json"}, [](BenchReport& report) { report.measure(); }), 3);
  EXPECT_EQ(run({}, [](BenchReport& report) { report.measure(); }), 0);
}

}  // namespace
}  // namespace papilla::bench
