// SPDX-License-Identifier: MIT
#include "papilla/pipeline/bake_jobs.hpp"

#include <fmt/core.h>
#include <oneapi/tbb/parallel_for.h>

#include <cctype>
#include <set>
#include <utility>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/trace.hpp"
#include "prepared_bake.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// Entries of values that have callbacks and deadlines, which no other process has.
struct InputSink {
  static constexpr bool leaves_out_transient = true;
  void write(const void* data, std::size_t size) { entry.write(data, size); }
  EntrySink& entry;
};
struct InputSource {
  static constexpr bool leaves_out_transient = true;
  void read(void* data, std::size_t size) { entry.read(data, size); }
  std::uint64_t most_bytes() const noexcept { return entry.most_bytes(); }
  EntrySource& entry;
};

/// FOLDER/results/ID.
struct JobRecord {
  Digest code{};   ///< code_digest() of the program that did it.
  Digest input{};  ///< Of the bytes of FOLDER/inputs/ID.
  std::vector<std::pair<std::string, Digest>> results;
};

fs::path input_of(const fs::path& folder, const std::string& id) { return folder / "inputs" / id; }
fs::path result_of(const fs::path& folder, const std::string& id) { return folder / "results" / id; }

Digest digest_of_file(const fs::path& path) {
  const std::string bytes = read_file(path);
  return sha256(bytes.data(), bytes.size());
}

/// Letters and digits of the name, the rest as '_'.
std::string plain_name(const std::string& name) {
  constexpr std::size_t k_longest = 40;
  std::string plain;
  for (const char c : name.substr(0, k_longest))
    plain += std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 128 ? c : '_';
  return plain;
}

/// Seconds of one core for a surface, start of the process included: what the parts of a cockpit took.
double estimated_seconds(std::size_t triangles) {
  constexpr double k_start = 0.1, k_per_triangle = 4e-5;
  return k_start + k_per_triangle * static_cast<double>(triangles);
}

using Works = std::vector<const SurfaceWork*>;

/// The surfaces that have something to compute, job by job.
std::vector<Works> grouped(const std::vector<SurfaceWork>& works, const SplitOptions& split) {
  std::vector<Works> by_part;
  for (const SurfaceWork& work : works) {
    if (work.equal_to != nullptr) continue;
    if (by_part.empty() || by_part.back().front()->surface->part != work.surface->part) by_part.emplace_back();
    by_part.back().push_back(&work);
  }
  if (!split.triangles) return by_part;
  std::vector<Works> jobs;
  std::size_t triangles = 0;
  for (Works& part : by_part) {
    std::size_t own = 0;
    for (const SurfaceWork* work : part) own += work->surface->triangles.size();
    if (jobs.empty() || triangles + own > *split.triangles) {
      jobs.emplace_back();
      triangles = 0;
    }
    jobs.back().insert(jobs.back().end(), part.begin(), part.end());
    triangles += own;
  }
  return jobs;
}

BakeJob write_job(const fs::path& folder, std::size_t number, const PreparedBake& prepared, const Works& works) {
  BakeJob job;
  job.id = fmt::format("{:05}-{}", number, plain_name(works.front()->surface->label));
  std::vector<SurfaceInput> inputs;
  for (const SurfaceWork* work : works) {
    const PartSurface& surface = *work->surface;
    job.surfaces.push_back({surface.part, surface.slot, surface.label});
    job.triangles += surface.triangles.size();
    inputs.push_back(prepared.input_of(*work));
  }
  job.cost_seconds = estimated_seconds(job.triangles);
  const fs::path path = input_of(folder, job.id);
  job.input_bytes = write_entry(
      path,
      [&](EntrySink& entry) {
        InputSink sink{entry};
        ValueWriter{sink}(code_digest(), inputs);
      },
      Durability::synced);
  job.input_sha256 = to_hex(digest_of_file(path));
  return job;
}

std::vector<SurfaceInput> read_job(const fs::path& path) {
  require_file(path);
  Digest code{};
  std::vector<SurfaceInput> inputs;
  const bool whole = read_entry(path, [&](EntrySource& entry) {
    InputSource source{entry};
    ValueReader read(source);
    read(code);
    if (code != code_digest())
      throw InvalidInput(path.string() + ": was written by another version of the program, or for another processor");
    read(inputs);
  });
  if (!whole) throw InvalidInput(path.string() + ": is no job's input, or damaged");
  return inputs;
}

std::optional<JobRecord> read_record(const fs::path& path) {
  JobRecord record;
  const bool whole = read_entry(path, [&](EntrySource& entry) { ValueReader{entry}(record); });
  return whole ? std::optional(std::move(record)) : std::nullopt;
}

/// The others are steps on the way.
bool is_asked_by_merge(std::string_view stage) { return stage == "uv" || stage == "seams" || stage == "measure"; }

}  // namespace

fs::path store_of_jobs(const fs::path& folder) { return folder / "store"; }

SplitResult split_bake(const fs::path& input, const fs::path& folder, const Materials& rules, BakeFileOptions options,
                       const SplitOptions& split, const ProgressCallback& progress) {
  const Stopwatch clock;
  for (const char* name : {"inputs", "results", "store"}) make_folder(folder / name);
  const StageCache cache(ContentStore(store_of_jobs(folder)), options.read.cache);
  options.read.cache = options.bake.unwrap.method.cache = &cache;
  SplitResult result;
  const PreparedBake prepared = prepare_file(input, rules, options, result.way, progress);
  std::set<std::uint32_t> parts;
  for (const Works& works : grouped(prepared.works, split)) {
    result.jobs.push_back(write_job(folder, result.jobs.size() + 1, prepared, works));
    for (const SurfaceWork* work : works) parts.insert(work->surface->part);
    result.surfaces += works.size();
  }
  if (const std::string problem = cache.problem(); !problem.empty()) throw IoError(problem);
  cache.report_to_shared();
  result.parts = parts.size();
  result.grains = prepared.result.grains.size();
  result.counts = cache.counts();
  result.seconds = clock.seconds();
  return result;
}

JobResult run_job(const fs::path& folder, const std::string& id, const StageCache* shared,
                  const ProgressCallback& progress) {
  const Stopwatch clock;
  JobResult result;
  const fs::path path = input_of(folder, id);
  std::vector<SurfaceInput> inputs = read_job(path);
  result.surfaces = inputs.size();
  if (problem_of_job(folder, id).empty()) {
    result.was_done = true;
    result.seconds = clock.seconds();
    return result;
  }
  const StageCache cache(ContentStore(store_of_jobs(folder)), shared);
  double triangles = 0;
  for (const SurfaceInput& input : inputs) triangles += static_cast<double>(input.mesh.triangles.size());
  SharedProgress done(progress, "surfaces", triangles);
  oneapi::tbb::parallel_for(std::size_t{0}, inputs.size(), [&](std::size_t i) {
    WorkProgress worked(done, static_cast<double>(inputs[i].mesh.triangles.size()));
    inputs[i].options.method.cache = &cache;
    inputs[i].options.method.progress = worked.callback();
    bake_surface(std::move(inputs[i]));
    worked.reach(1);
  });
  if (const std::string problem = cache.problem(); !problem.empty()) throw IoError(problem);
  cache.report_to_shared();
  JobRecord record{code_digest(), digest_of_file(path), {}};
  for (const auto& [stage, key] : cache.results())
    if (is_asked_by_merge(stage)) record.results.emplace_back(stage, key);
  make_folder(folder / "results");
  write_entry(
      result_of(folder, id), [&](EntrySink& entry) { ValueWriter{entry}(record); }, Durability::synced);
  result.counts = cache.counts();
  result.seconds = clock.seconds();
  return result;
}

std::string problem_of_job(const fs::path& folder, const std::string& id) {
  const fs::path path = result_of(folder, id);
  std::error_code error;
  if (!fs::exists(path, error)) return "has no result";
  const std::optional<JobRecord> record = read_record(path);
  if (!record) return "its result is damaged";
  if (record->code != code_digest())
    return "its result is that of another version of the program, or of another processor";
  if (!fs::exists(input_of(folder, id), error) || record->input != digest_of_file(input_of(folder, id)))
    return "its result is that of another input";
  const ContentStore store(store_of_jobs(folder));
  for (const auto& [stage, key] : record->results)
    if (!is_entry_whole(store.path_of(stage, key))) return "its result '" + stage + "' is missing or damaged";
  return {};
}

}  // namespace papilla
