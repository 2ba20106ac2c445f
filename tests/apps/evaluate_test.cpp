// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>

#include "evaluate/built_in.hpp"
#include "evaluate/evaluation_files.hpp"
#include "evaluate/pareto.hpp"
#include "papilla/core/temporary_folder.hpp"

namespace papilla::app {
namespace {

int g_runs = 0;

/// Takes a little longer every time, with the same error.
std::vector<EvaluationRun> slower_each_time(const EvaluationInput& input) {
  ++g_runs;
  return {{"method", "", input.file, "error", {{0.1 * g_runs, 4}, {0.2 * g_runs, 2}}, "converged"}};
}

TEST(Pareto, HoldsWhatNobodyBeats) {
  const Trace fast{{0.1, 1}}, good{{0.5, 2}, {1, 0.1}}, beaten{{2, 0.2}}, never{{0.01, INFINITY}};
  const Trace front = pareto_front({fast, good, beaten, never});
  ASSERT_EQ(front.size(), 2U);
  EXPECT_EQ(front[0].error, 1);
  EXPECT_EQ(front[1].error, 0.1);
  EXPECT_TRUE(reaches_front(fast, front));
  EXPECT_TRUE(reaches_front(good, front));
  EXPECT_FALSE(reaches_front(beaten, front));
  EXPECT_FALSE(reaches_front(never, front));
}

TEST(Evaluation, RepeatsAndTakesMedians) {
  g_runs = 0;
  const auto runs = run_repeatedly({"slower", "", slower_each_time}, {"file", "file", {}, {}}, 3);
  EXPECT_EQ(g_runs, 3);
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].repeats.size(), 3U);
  EXPECT_DOUBLE_EQ(runs[0].trace[0].seconds, 0.2);
  EXPECT_DOUBLE_EQ(runs[0].trace[1].seconds, 0.4);
  EXPECT_EQ(runs[0].trace[1].error, 2);
}

TEST(Evaluation, RunsOnceWhenTheTimeIsSpent) {
  g_runs = 0;
  const auto runs = run_repeatedly({"slower", "", slower_each_time}, {"file", "file", {}, {}, Budget(0)}, 5);
  EXPECT_EQ(g_runs, 1);
  EXPECT_EQ(runs[0].repeats.size(), 1U);
}

TEST(Evaluation, InvalidResultsAreOnNoFront) {
  std::vector<EvaluationRun> runs{{"flips", "", "file", "error", {{0.1, 0.001}}, "direct"},
                                  {"holds", "", "file", "error", {{1, 0.1}}, "direct"},
                                  {"other", "", "file 2", "error", {{1, 0.1}}, "direct"}};
  runs[0].valid = false;
  const auto groups = runs_groups(runs);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].runs.size(), 2U);
  EXPECT_EQ(groups[0].on_front, std::vector<std::string>{"holds"});
}

TEST(Evaluation, QuotesAndEscapesNames) {
  const std::vector<EvaluationRun> runs{
      {"a<b>", "\"x\"", "f,1", "error", {{0.5, 2}}, "direct", "<script>", true, {}, {{{0.25, 2}}}}};
  EXPECT_EQ(runs_csv(runs),
            "method,solver,input,error_name,repeat,seconds,error\r\n"
            "a<b>,\"\"\"x\"\"\",\"f,1\",error,0,0.5,2\r\n"
            "a<b>,\"\"\"x\"\"\",\"f,1\",error,1,0.25,2\r\n");
  const std::string html = runs_html("kind", {}, runs);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_NE(html.find("a&lt;b&gt;"), std::string::npos);
  EXPECT_EQ(runs_json(runs)[0]["repeats"][0][0]["seconds"], 0.25);
}

TEST(Evaluation, HasInputsOfItsOwnThatItCanRead) {
  for (const EvaluationKind& kind : evaluation_kinds()) {
    const TemporaryFolder folder("papilla-test");
    const std::vector<std::string> files = write_built_in_inputs(std::string(kind.name), folder.path());
    EXPECT_EQ(files.empty(), kind.name == "tessellation" || kind.name == "contact") << kind.name;
    for (const std::string& file : files) EXPECT_GT(std::filesystem::file_size(file), 100U) << file;
  }
}

TEST(Budget, SharesWhatIsLeft) {
  const Budget endless;
  EXPECT_TRUE(endless.allows(1e9));
  const Budget minute(60);
  EXPECT_TRUE(minute.allows(30));
  EXPECT_FALSE(minute.allows(61));
  EXPECT_NEAR(minute.share(4).seconds(), 15, 0.1);
  EXPECT_TRUE(Budget(0).spent());
}

}  // namespace
}  // namespace papilla::app
