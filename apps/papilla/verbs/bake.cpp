// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <memory>
#include <string>

#include "bake/bake_arguments.hpp"
#include "bake/job_text.hpp"
#include "exit_code.hpp"
#include "file_options.hpp"
#include "options/cache_option.hpp"
#include "papilla/pipeline/bake_jobs.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  BakeArguments arguments;
  BakeOutputs outputs;
  std::string job;
  const CLI::App* verb = nullptr;
};

/// --job FOLDER/ID. A cache is one that somebody named: the folder of whoever runs jobs is nobody's else. It is left as
/// large as it got, which split sees to: a thousand jobs that each look through all of it take longer than they save.
Json run_one_job(const Options& options, VerbContext& context) {
  const std::filesystem::path job = options.job;
  const StageCache* cache = is_cache_named(*options.verb) ? context.cache : nullptr;
  context.cache = nullptr;
  const std::filesystem::path folder = job.parent_path().empty() ? "." : job.parent_path();
  const JobResult result = run_job(folder, job.filename().string(), cache, context.progress);
  context.console.print(job_line(job.string(), result));
  Json json = job_json(job.filename().string(), result);
  if (cache != nullptr) {
    context.console.print(cache_line(*cache));
    json["cache"] = cache_json(*cache);
  }
  return json;
}

void require(const std::string& value, const char* name) {
  if (value.empty()) throw UsageError(std::string(name) + " is required");
}

Json run(const Options& options, VerbContext& context) {
  if (!options.job.empty()) return run_one_job(options, context);
  require(options.arguments.input, "SCENE");
  require(options.arguments.materials, "--materials");
  require(options.outputs.output, "--output");
  return write_bake(options.arguments, options.outputs, options.arguments.options(options.outputs.output, context),
                    context);
}

}  // namespace

void add_bake(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(
      program,
      {"bake", "The main job: grain and touch onto a scene, as glTF; a glTF scene keeps all else that it holds.",
       "papilla bake data/cockpit.step -m examples/materials.json -o cockpit.glb --report report",
       VerbInfo::AtDeadline::ends, VerbInfo::Remembers::yes},
      [options](VerbContext& context) { return run(*options, context); });
  options->verb = verb;
  options->arguments.add_to(*verb);
  options->outputs.add_to(*verb);
  CLI::Option* const job =
      verb->add_option("--job", options->job, "Do one job of papilla split, FOLDER/ID, and nothing else");
  reads(job)->type_name("JOB");
  for (const char* other : {"SCENE", "--materials", "--output", "--report"}) job->excludes(verb->get_option(other));
}

}  // namespace papilla::app
