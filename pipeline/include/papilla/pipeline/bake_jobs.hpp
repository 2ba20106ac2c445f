// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/pipeline/bake_file.hpp"

namespace papilla {

// A bake in three steps, so that machines that share a folder can do the middle one together:
//   split_bake()  reads the scene, tessellates, plans, makes the grains, and writes one input a job;
//   run_job()     makes the uv of its surfaces and measures them;
//   merge         is bake_file() with the folder's store as its cache, which has everything but the writing.
// FOLDER/inputs/ID is what a job needs, FOLDER/results/ID what it made, by keys of FOLDER/store.

/// How surfaces are put together to jobs.
struct SplitOptions {
  /// Parts follow one another in a job until it has so many triangles; a part is never divided. Not given: one a part.
  std::optional<std::size_t> triangles;
};

struct JobSurface {
  std::uint32_t part = 0, slot = 0;  ///< As in PartSurface.
  std::string label;
};

struct BakeJob {
  std::string id;  ///< Number and name of its first surface, of letters that need no quotes.
  std::vector<JobSurface> surfaces;
  std::size_t triangles = 0;
  double cost_seconds = 0;  ///< Estimated processor time.
  std::uint64_t input_bytes = 0;
  std::string input_sha256;  ///< Of FOLDER/inputs/ID.
};

struct SplitResult {
  BakeWay way;
  std::vector<BakeJob> jobs;
  std::size_t surfaces = 0, parts = 0, grains = 0;
  CacheCounts counts;  ///< Of the folder's store.
  double seconds = 0;
};

/// The store that the jobs of a folder share.
std::filesystem::path store_of_jobs(const std::filesystem::path& folder);

/// @param folder Is made when it is missing. What a split of the same scene left there is used again.
/// @param options As of bake_file(). Their cache, read.cache, is shared with others: what it has is taken from there.
/// @throws as plan_file() and make_grain(); IoError when the folder can't be written.
SplitResult split_bake(const std::filesystem::path& input, const std::filesystem::path& folder, const Materials& rules,
                       BakeFileOptions options, const SplitOptions& split, const ProgressCallback& progress = {});

struct JobResult {
  bool was_done = false;  ///< Its result was whole already, and nothing was computed.
  std::size_t surfaces = 0;
  CacheCounts counts;
  double seconds = 0;
};

/// Does one job; done again it changes nothing. Surfaces run in parallel.
/// @param shared A cache of other bakes: what it has is taken from there, and what is made goes there, too. Or null.
/// @throws InvalidInput when its input is missing, damaged or of another version of the program; IoError when the
///         store can't be written; SolverFailure, InvalidInput naming the part.
JobResult run_job(const std::filesystem::path& folder, const std::string& id, const StageCache* shared = nullptr,
                  const ProgressCallback& progress = {});

/// What is wrong with a job's result; empty when it is whole. Reads all of it.
std::string problem_of_job(const std::filesystem::path& folder, const std::string& id);

}  // namespace papilla
