// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "evaluate/kinds.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/grain.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

class EvaluateTexture : public testing::Test {
 protected:
  EvaluateTexture() { fs::create_directories(folder_); }
  ~EvaluateTexture() override { fs::remove_all(folder_); }
  std::string file(const char* name) const { return (folder_ / name).string(); }
  const GrainResult grain_ = synthesize_grain(GrainKind::spheres8, {.size_px = 144});

 private:
  fs::path folder_ = fs::temp_directory_path() / ("papilla-evaluate-" + std::to_string(::getpid()));
};

TEST_F(EvaluateTexture, FractalRunsEveryEstimatorOnEverySize) {
  write_grey_image(file("grain.png"), grain_.picture, 8);
  const std::vector<EvaluationRun> runs = evaluate_fractal({file("grain.png"), "grain.png", {}, {}});
  ASSERT_EQ(runs.size(), 6U);
  for (const EvaluationRun& run : runs) {
    EXPECT_EQ(run.trace.size(), run.method == "probability" ? 2U : 3U) << run.method;
    EXPECT_FALSE(run.notes.empty());
  }
}

TEST_F(EvaluateTexture, SymmetryLeavesLittleOfARegularGrain) {
  write_grey_image(file("grain.png"), grain_.picture, 8);
  const std::vector<EvaluationRun> runs = evaluate_symmetry({file("grain.png"), "grain.png", {}, {}});
  ASSERT_EQ(runs.size(), 3U);
  for (const EvaluationRun& run : runs) EXPECT_LT(run.trace.back().error, 0.1) << run.method;
}

TEST_F(EvaluateTexture, HeightKnowsTheErrorOfAReliefAndTheResidualOfAPicture) {
  write_height_float(file("grain.exr"), grain_.relief);
  const std::vector<EvaluationRun> known = evaluate_height({file("grain.exr"), "grain.exr", {}, {}});
  ASSERT_EQ(known.size(), 12U);
  const auto least = [](const EvaluationRun& run) {
    return std::min_element(run.trace.begin(), run.trace.end(),
                            [](const TraceSample& a, const TraceSample& b) { return a.error < b.error; })
        ->error;
  };
  EXPECT_EQ(known[8].method, "variational");
  EXPECT_LT(least(known[8]), 0.2);
  EXPECT_EQ(known[3].method, "intensity");
  EXPECT_EQ(known[3].trace.size(), 3U);  // 64, 128 and 144 pixels
  write_grey_image(file("grain.png"), grain_.picture, 8);
  const std::vector<EvaluationRun> unknown = evaluate_height({file("grain.png"), "grain.png", {}, {}});
  ASSERT_EQ(unknown.size(), 3U);
  EXPECT_NE(unknown[0].error_name, known[0].error_name);
}

TEST_F(EvaluateTexture, NothingBeginsWhenTheTimeIsSpentAndAllIsNamed) {
  write_height_float(file("grain.exr"), grain_.relief);
  write_grey_image(file("grain.png"), grain_.picture, 8);
  const auto expect_named = [](const std::vector<EvaluationRun>& runs) {
    EXPECT_FALSE(runs.empty());
    for (const EvaluationRun& run : runs) {
      EXPECT_TRUE(run.trace.empty()) << run.name();
      EXPECT_EQ(run.stop, k_time_spent) << run.name();
    }
  };
  expect_named(evaluate_height({file("grain.exr"), "grain.exr", {}, {}, Budget(0)}));
  expect_named(evaluate_fractal({file("grain.png"), "grain.png", {}, {}, Budget(0)}));
  expect_named(evaluate_symmetry({file("grain.png"), "grain.png", {}, {}, Budget(0)}));
}

}  // namespace
}  // namespace papilla
