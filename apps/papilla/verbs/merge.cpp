// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bake/bake_arguments.hpp"
#include "bake/job_text.hpp"
#include "bake/saved_arguments.hpp"
#include "exit_code.hpp"
#include "file_options.hpp"
#include "options/cache_option.hpp"
#include "papilla/core/error.hpp"
#include "papilla/pipeline/bake_jobs.hpp"
#include "shown_format.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string folder;
  BakeOutputs outputs;
  bool allow_missing = false;
};

struct BadJob {
  const BakeJob* job = nullptr;
  std::string problem;
};

std::vector<BadJob> bad_jobs(const fs::path& folder, const std::vector<BakeJob>& jobs, const VerbContext& context) {
  std::vector<BadJob> bad;
  for (const BakeJob& job : jobs) {
    report_progress(context.progress, "check",
                    static_cast<double>(&job - jobs.data()) / static_cast<double>(jobs.size()));
    if (std::string problem = problem_of_job(folder, job.id); !problem.empty())
      bad.push_back({&job, std::move(problem)});
  }
  return bad;
}

std::string bad_jobs_text(const fs::path& folder, const std::vector<BadJob>& bad, std::size_t jobs) {
  constexpr std::size_t k_most_named = 20;
  std::string text = shown_format("{}: {} of {} jobs have no whole result: ", folder.string(), bad.size(), jobs);
  for (std::size_t i = 0; i < bad.size() && i < k_most_named; ++i)
    text += shown_format("{}{} {}", i > 0 ? "; " : "", bad[i].job->id, bad[i].problem);
  if (bad.size() > k_most_named) text += shown_format("; and {} more", bad.size() - k_most_named);
  return text;
}

Json run(const Options& options, VerbContext& context) {
  const fs::path folder = options.folder;
  const BakeArguments arguments = read_arguments(folder);
  const std::vector<BakeJob> jobs = read_manifest(folder);
  const std::vector<BadJob> bad = bad_jobs(folder, jobs, context);
  if (!bad.empty() && !options.allow_missing)
    throw InvalidInput(bad_jobs_text(folder, bad, jobs.size()) +
                       "; --allow-missing leaves their surfaces as they came");
  const StageCache store{ContentStore(store_of_jobs(folder))};
  context.cache = &store;
  BakeFileOptions wanted = arguments.options(options.outputs.output, context);
  Json left_out = Json::array();
  for (const BadJob& one : bad) {
    for (const JobSurface& surface : one.job->surfaces) wanted.bake.without_grain.emplace(surface.part, surface.slot);
    left_out.push_back({{"job", one.job->id}, {"problem", one.problem}});
  }
  if (!bad.empty()) context.console.print(bad_jobs_text(folder, bad, jobs.size()) + "; left out\n");
  Json json = write_bake(arguments, options.outputs, std::move(wanted), context);
  json["jobs"] = {{"folder", folder.string()}, {"jobs", jobs.size()}, {"left_out", left_out}};
  json["cache"] = cache_json(store);
  context.console.print(cache_line(store));
  context.cache = nullptr;
  return json;
}

}  // namespace

void add_merge(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"merge", "Puts the results of a split bake's jobs together: the very bytes of the whole bake.",
                "papilla merge jobs -o cockpit.glb --report report", VerbInfo::AtDeadline::ends},
               [options](VerbContext& context) { return run(*options, context); });
  verb->add_option("JOBS", options->folder, "Folder of papilla split")->type_name("DIR")->required();
  options->outputs.add_to(*verb);
  verb->get_option("--output")->required();
  verb->add_flag("--allow-missing", options->allow_missing,
                 "Surfaces of jobs without a whole result stay as they came, without grain; else they are named and "
                 "nothing is written");
}

}  // namespace papilla::app
