// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "evaluate/kinds.hpp"
#include "evaluate/wall_press.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"
#include "papilla/io/scene_file.hpp"

namespace papilla {
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
  const auto groups = group_runs(runs);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].runs.size(), 2U);
  EXPECT_EQ(groups[0].on_front, std::vector<std::string>{"holds"});
}

TEST(Evaluation, NamesFilesAndRefusesUnknownKinds) {
  EXPECT_THROW(evaluate({.kind = "no such kind"}), InvalidInput);
  const TemporaryFolder folder("papilla-test");
  const std::vector<std::string> files = write_built_in_inputs("weld", folder.path());
  const Evaluation evaluation = evaluate({.kind = "weld", .files = files, .read = {}, .repeats = 1});
  EXPECT_EQ(evaluation.files, files);
  ASSERT_FALSE(evaluation.runs.empty());
  EXPECT_EQ(evaluation.runs[0].input.find(folder.path().string()), std::string::npos);
}

TEST(Evaluation, HasInputsOfItsOwnThatItCanRead) {
  for (const EvaluationKind& kind : evaluation_kinds()) {
    const TemporaryFolder folder("papilla-test");
    const std::vector<std::string> files = write_built_in_inputs(kind.name, folder.path());
    EXPECT_FALSE(files.empty()) << kind.name;
    for (const std::string& file : files) EXPECT_GT(std::filesystem::file_size(file), 100U) << file;
  }
  const TemporaryFolder folder("papilla-test");
  for (const std::string& file : write_built_in_inputs("charts", folder.path())) {
    const Scene scene = read_scene(file);
    ASSERT_EQ(scene.parts.size(), 1U) << file;
    EXPECT_GT(scene.parts[0].mesh.triangles.size(), 100U) << file;
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

TEST(Ladder, EndWhenTheNextOneIsTooLong) {
  const Budget endless, none(0), short_one(1e-4);
  Ladder always(endless, 1e9), never(none, 1), once(short_one, 1e9);
  EXPECT_TRUE(always.next());
  EXPECT_TRUE(always.next());
  EXPECT_FALSE(never.next());
  once.next();
  EXPECT_FALSE(once.next());
}

/// A dome over the unit square, of 2 n² triangles.
TriangleMesh dome(int n, double height) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = 1.0 * i / n, y = 1.0 * j / n;
      mesh.positions.push_back({x, y, height * x * (1 - x) * y * (1 - y)});
    }
  const auto at = [n](int i, int j) { return static_cast<Index>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TEST(EvaluateEnvironment, ErrsLessOnFinerMeshes) {
  for (const auto& [name, map] : environment_maps()) {
    const auto last = [&](int n) {
      return environment_run(dome(n, 4), map, name, "dome", Budget()).trace.back().error;
    };
    const double coarse = last(8), fine = last(32);
    EXPECT_GT(coarse, 0) << name;
    EXPECT_NEAR(coarse / fine, 4, 1.5) << name;  // by the length of the edges
  }
}

TEST(EvaluateParam, HasTheSourcesMethodsAsTheyAreWritten) {
  const TemporaryFolder folder("papilla-test");
  Part part;
  part.mesh = dome(10, 4);
  const std::string file = (folder.path() / "dome.ply").string();
  write_scene(single_part_scene(std::move(part), "PLY"), file);
  EvaluationInput input{file, "dome.ply", {}, {}};
  input.param.methods = {UnwrapMethod::levy, UnwrapMethod::maillot};
  const std::vector<EvaluationRun> runs = evaluate_param(input);
  const auto find = [&](const std::string& solver, const std::string& error) -> const EvaluationRun& {
    return *std::find_if(runs.begin(), runs.end(), [&](const EvaluationRun& run) {
      return run.solver == solver && run.error_name.starts_with(error);
    });
  };
  for (const char* solver : {"direct, as written", "gauss-seidel, as written", "direct, as written, border released",
                             "gauss-seidel, as written, border released"}) {
    const EvaluationRun& own = find(solver, "Lévy");
    ASSERT_GE(own.trace.size(), 2U) << solver;
    EXPECT_LT(own.trace.back().error, own.trace.front().error) << solver;
    EXPECT_TRUE(find(solver, "symmetric").map->valid) << solver;
  }
  double start = 0;
  for (const char* from : {"conformal", "planar"}) {
    const std::string solver = std::string("as written from ") + from;
    const EvaluationRun& own = find(solver, "Maillot energy");
    ASSERT_GE(own.trace.size(), 2U) << solver;
    EXPECT_NE(own.trace.front().error, start);  // each from its own start
    EXPECT_LT(own.trace.back().error, 0.9 * own.trace.front().error) << solver;
    start = own.trace.front().error;
    const EvaluationRun& dirichlet = find(solver, "symmetric");
    EXPECT_GT(dirichlet.trace.front().error, dirichlet.trace.back().error) << solver;  // the first is the start's
    EXPECT_NE(dirichlet.notes.find(fmt::format("Maillot energy [mm²]: {:.5g} at the start", start)), std::string::npos)
        << dirichlet.notes;
  }
}

TEST(EvaluateCharts, SeamsOfASheetAreNotWorthIt) {
  const TemporaryFolder folder("papilla-test");
  Part part;
  part.mesh = dome(10, 0);
  const std::string file = (folder.path() / "sheet.ply").string();
  write_scene(single_part_scene(std::move(part), "PLY"), file);
  const std::vector<EvaluationRun> runs = evaluate_charts({file, "sheet.ply", {}, {}});
  ASSERT_EQ(runs.size(), 2U);
  for (const TraceSample& s : runs[0].trace) EXPECT_NEAR(s.error, 0, 1e-9);
  for (const TraceSample& s : runs[1].trace) EXPECT_EQ(s.error, 0);
  EXPECT_EQ(runs[1].trace.size(), 6U);
}

TEST(PressWall, HoldsWhatIsSoftAndShakesWhatIsStiff) {
  const DeviceCaps touch = device_preset("touch").caps();
  const WallResponse soft = press_wall(touch, {.stiffness = 100}), stiff = press_wall(touch, {.stiffness = 1e5});
  EXPECT_LT(soft.rest_speed_m_per_s, k_still_m_per_s);
  EXPECT_EQ(soft.given_j.back(), 0);
  EXPECT_EQ(soft.given_j.size(), 3000U);
  EXPECT_NEAR(soft.largest_force_n, 300 * 1e-2 * 100 / 400,
              1.2);  // two springs in a row, and what the hand brings along
  EXPECT_GT(stiff.rest_speed_m_per_s, k_still_m_per_s);
  EXPECT_GT(stiff.given_j.back(), 0.1);
  const WallResponse clamped = press_wall(touch, {.stiffness = 1e5, .clamp = true});
  EXPECT_DOUBLE_EQ(clamped.stiffness, stiffness_limit(touch.dynamics, 1e-3, 0));
  EXPECT_LT(clamped.rest_speed_m_per_s, k_still_m_per_s);
}

}  // namespace
}  // namespace papilla
