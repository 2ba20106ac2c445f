// SPDX-License-Identifier: MIT
#include "papilla/pipeline/bake_jobs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/temporary_folder.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// Two parts of CAD, each with a material of its own.
class BakeJobs : public testing::Test {
 protected:
  static constexpr const char* k_rules = R"({"materials": {
      "cap": {"texture": "grain:leather", "size_mm": [30, 20], "stiffness": 600},
      "column": {"texture": "grain:ovals6", "size_mm": [10, 16], "stiffness": 900}},
    "assign": [{"part": "knob_cap", "material": "cap"}, {"part": "steering_column", "material": "column"}]})";

  BakeJobs() { scene_ = fs::path(PAPILLA_DATA) / "exchange" / "knobs.step"; }

  Materials rules(const std::string& text = k_rules) const {
    std::ofstream(folder_ / "materials.json") << text;
    return read_materials(folder_ / "materials.json");
  }

  /// @return the file's bytes.
  std::string bake(const Materials& rules, const StageCache* cache, const fs::path& scene,
                   BakeFileOptions options = {}) const {
    options.read.cache = options.bake.unwrap.method.cache = cache;
    fs::remove(folder_ / "scene.glb");
    bake_file(scene, folder_ / "scene.glb", rules, options);
    return read_file(folder_ / "scene.glb");
  }
  std::string bake(const StageCache* cache = nullptr) const { return bake(rules(), cache, scene_); }

  static CacheCount count(const StageCache& cache, const std::string& stage) {
    const CacheCounts counts = cache.counts();
    const auto found = counts.find(stage);
    return found == counts.end() ? CacheCount{} : found->second;
  }
  static void expect(const StageCache& cache, const std::string& stage, std::size_t found, std::size_t made) {
    EXPECT_EQ(count(cache, stage).found, found) << stage;
    EXPECT_EQ(count(cache, stage).made, made) << stage;
  }

  fs::path jobs() const { return folder_ / "jobs"; }
  SplitResult split(const SplitOptions& by = {}) const { return split_bake(scene_, jobs(), rules(), {}, by); }
  std::string merge(BakeFileOptions options = {}) const {
    const StageCache store{ContentStore(store_of_jobs(jobs()))};
    const std::string bytes = bake(rules(), &store, scene_, std::move(options));
    merged_ = store.counts();
    return bytes;
  }

  TemporaryFolder folder_{"jobs"};
  fs::path scene_;
  mutable CacheCounts merged_;
};

TEST_F(BakeJobs, ACacheChangesNoByte) {
  const std::string plain = bake();
  const StageCache first{ContentStore(folder_ / "cache")}, second{ContentStore(folder_ / "cache")};
  EXPECT_EQ(bake(&first), plain);
  EXPECT_EQ(bake(&second), plain);
  expect(first, "tessellation", 0, 2);
  expect(first, "uv", 0, 2);
  for (const char* stage : {"scene", "sides"}) expect(second, stage, 1, 0);
  for (const char* stage : {"grain", "uv", "measure"}) expect(second, stage, 2, 0);
  EXPECT_EQ(count(second, "tessellation").found + count(second, "tessellation").made, 0u);
}

TEST_F(BakeJobs, DamagedEntriesAreMadeAnew) {
  const std::string plain = bake();
  const ContentStore store(folder_ / "cache");
  {
    const StageCache cache{store};
    bake(&cache);
  }
  std::size_t damaged = 0;
  for (const auto& entry : fs::recursive_directory_iterator(store.folder()))
    if (entry.is_regular_file()) fs::resize_file(entry.path(), entry.file_size() - 1), ++damaged;
  EXPECT_GT(damaged, 8u);
  const StageCache cache{store};
  EXPECT_EQ(bake(&cache), plain);
  for (const auto& [stage, counted] : cache.counts()) EXPECT_EQ(counted.found, 0u) << stage;
  EXPECT_TRUE(store.verify().damaged.empty());
}

TEST_F(BakeJobs, AnotherMaterialCostsItsOwnGrainAndParts) {
  std::string text = k_rules;
  text.replace(text.find("[10, 16]"), 8, "[10, 18]");
  const StageCache first{ContentStore(folder_ / "cache")}, second{ContentStore(folder_ / "cache")};
  bake(&first);
  const std::string cached = bake(rules(text), &second, scene_);
  EXPECT_EQ(cached, bake(rules(text), nullptr, scene_));
  for (const char* stage : {"grain", "uv", "measure"}) expect(second, stage, 1, 1);
  for (const char* stage : {"scene", "map"}) expect(second, stage, 1, 0);
}

TEST_F(BakeJobs, AMaterialThatOnlyFeelsDifferentCostsNoUv) {
  std::string text = k_rules;
  text.replace(text.find("900"), 3, "950");
  const StageCache first{ContentStore(folder_ / "cache")}, second{ContentStore(folder_ / "cache")};
  bake(&first);
  EXPECT_EQ(bake(rules(text), &second, scene_), bake(rules(text), nullptr, scene_));
  expect(second, "uv", 2, 0);
  expect(second, "grain", 1, 1);
}

TEST_F(BakeJobs, AnotherCadFaceCostsItsPartOnly) {
  const StageCache first{ContentStore(folder_ / "cache")}, second{ContentStore(folder_ / "cache")};
  bake(&first);
  std::string step = read_file(scene_);
  const std::string face = "CYLINDRICAL_SURFACE('',#59,15.)";
  ASSERT_NE(step.find(face), std::string::npos);
  step.replace(step.find(face), face.size(), "CYLINDRICAL_SURFACE('',#59,15.001)");
  const fs::path changed = folder_ / "knobs.step";
  std::ofstream(changed) << step;
  EXPECT_EQ(bake(rules(), &second, changed), bake(rules(), nullptr, changed));
  expect(second, "scene", 0, 1);
  expect(second, "tessellation", 1, 1);
  expect(second, "uv", 1, 1);
  expect(second, "measure", 1, 1);
  expect(second, "grain", 2, 0);
}

TEST_F(BakeJobs, ANewPartLeavesTheOthersAlone) {
  const StageCache first{ContentStore(folder_ / "cache")}, second{ContentStore(folder_ / "cache")};
  std::string text = k_rules;
  text.replace(text.find("\"steering_column\""), 17, "\"nothing\"");
  bake(rules(text), &first, scene_);
  expect(first, "uv", 0, 1);
  bake(&second);
  expect(second, "uv", 1, 1);
}

TEST_F(BakeJobs, MergedJobsAreTheWholeBake) {
  const std::string whole = bake();
  const SplitResult split = this->split();
  ASSERT_EQ(split.jobs.size(), 2u);
  EXPECT_EQ(split.jobs[0].surfaces.size(), 1u);
  EXPECT_EQ(split.jobs[0].surfaces[0].label, "knob_cap");
  EXPECT_EQ(split.jobs[0].triangles, 1820u);
  for (const BakeJob& job : split.jobs) {
    EXPECT_EQ(problem_of_job(jobs(), job.id), "has no result");
    EXPECT_FALSE(run_job(jobs(), job.id).was_done);
    EXPECT_EQ(problem_of_job(jobs(), job.id), "");
    EXPECT_TRUE(run_job(jobs(), job.id).was_done);
  }
  EXPECT_EQ(merge(), whole);
  for (const auto& [stage, counted] : merged_) EXPECT_EQ(counted.made, 0u) << stage;
}

TEST_F(BakeJobs, PartsGoTogetherUpToATriangleCount) {
  EXPECT_EQ(split({1}).jobs.size(), 2u);
  EXPECT_EQ(split({3175}).jobs.size(), 2u);
  const SplitResult together = split({3176});
  ASSERT_EQ(together.jobs.size(), 1u);
  EXPECT_EQ(together.jobs[0].surfaces.size(), 2u);
  EXPECT_EQ(together.jobs[0].triangles, 3176u);
  run_job(jobs(), together.jobs[0].id);
  EXPECT_EQ(merge(), bake());
}

TEST_F(BakeJobs, ASharedCacheSavesTheWorkOfAnotherSplit) {
  const std::string whole = bake();
  const StageCache filled{ContentStore(folder_ / "cache")};
  bake(&filled);
  const StageCache shared{ContentStore(folder_ / "cache")};
  BakeFileOptions options;
  options.read.cache = &shared;
  const SplitResult split = split_bake(scene_, jobs(), rules(), options, {});
  for (const char* stage : {"scene", "sides"}) expect(shared, stage, 1, 0);
  expect(shared, "grain", 2, 0);
  for (const BakeJob& job : split.jobs) EXPECT_FALSE(run_job(jobs(), job.id, &shared).was_done);
  expect(shared, "uv", 2, 0);
  expect(shared, "measure", 2, 0);
  shared.store().clear();  // What jobs need is theirs.
  EXPECT_EQ(merge(), whole);
  for (const auto& [stage, counted] : merged_) EXPECT_EQ(counted.made, 0u) << stage;
}

TEST_F(BakeJobs, SaysWhatIsWrongWithAResult) {
  const SplitResult split = this->split();
  const std::string id = split.jobs[0].id;
  run_job(jobs(), id);
  const fs::path result = jobs() / "results" / id;
  const std::string record = read_file(result);
  fs::resize_file(result, 40);
  EXPECT_EQ(problem_of_job(jobs(), id), "its result is damaged");
  EXPECT_FALSE(run_job(jobs(), id).was_done);
  EXPECT_EQ(read_file(result), record);

  // What the store lost, or what another input replaced.
  for (const auto& entry : fs::recursive_directory_iterator(jobs() / "store" / "uv"))
    if (entry.is_regular_file()) fs::resize_file(entry.path(), entry.file_size() - 1);
  EXPECT_EQ(problem_of_job(jobs(), id), "its result 'uv' is missing or damaged");
  run_job(jobs(), id);
  EXPECT_EQ(problem_of_job(jobs(), id), "");
  fs::copy_file(jobs() / "inputs" / split.jobs[1].id, jobs() / "inputs" / id, fs::copy_options::overwrite_existing);
  EXPECT_EQ(problem_of_job(jobs(), id), "its result is that of another input");
}

TEST_F(BakeJobs, RefusesInputsThatAreMissingOrDamaged) {
  const std::string id = split().jobs[0].id;
  EXPECT_THROW(run_job(jobs(), "00009-none"), IoError);
  const fs::path input = jobs() / "inputs" / id;
  fs::resize_file(input, fs::file_size(input) - 1);
  try {
    run_job(jobs(), id);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find(id), std::string::npos) << error.what();
  }
}

TEST_F(BakeJobs, SurfacesWithoutAResultStayAsTheyCame) {
  const SplitResult split = this->split();
  run_job(jobs(), split.jobs[1].id);
  BakeFileOptions options;
  for (const JobSurface& surface : split.jobs[0].surfaces)
    options.bake.without_grain.emplace(surface.part, surface.slot);
  const std::string without = merge(options);
  std::string text = k_rules;
  text.replace(text.find("\"knob_cap\""), 10, "\"nothing\"");
  EXPECT_EQ(without, bake(rules(text), nullptr, scene_));
  EXPECT_EQ(merged_["uv"].made, 0u);
}

}  // namespace
}  // namespace papilla
