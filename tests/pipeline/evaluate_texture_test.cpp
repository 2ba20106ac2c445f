// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "evaluate/kinds.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/stein_surface.hpp"

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
  write_grey_image(file("rough.png"), to_grey_image(brownian_surface_exact({145, 0.5, 3})), 8);
  const std::vector<EvaluationRun> runs = evaluate_fractal({file("rough.png"), "rough.png", {}, {}});
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
  const auto least_of = [&](const char* method) {
    double least = 1e300;
    for (const EvaluationRun& run : known)
      for (const TraceSample& sample : run.trace)
        if (run.method == method && run.error_name == known.front().error_name) least = std::min(least, sample.error);
    return least;
  };
  for (const char* method : {"variational", "wiener", "pentland"}) EXPECT_LT(least_of(method), 0.2) << method;
  const auto intensity =
      std::find_if(known.begin(), known.end(), [](const EvaluationRun& run) { return run.method == "intensity"; });
  ASSERT_NE(intensity, known.end());
  EXPECT_EQ(intensity->trace.size(), 3U);  // 64, 128 and 144 pixels
  write_grey_image(file("grain.png"), grain_.picture, 8);
  const std::vector<EvaluationRun> unknown = evaluate_height({file("grain.png"), "grain.png", {}, {}});
  ASSERT_GE(unknown.size(), 3U);
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
