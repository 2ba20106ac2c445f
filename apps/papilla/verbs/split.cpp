// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "bake/bake_arguments.hpp"
#include "bake/job_text.hpp"
#include "bake/saved_arguments.hpp"
#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/scene_json.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/pipeline/bake_jobs.hpp"
#include "shown_format.hpp"
#include "text/scene_text.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  BakeArguments arguments;
  std::string folder, by = "part";
  const CLI::App* verb = nullptr;
};

SplitOptions split_options(const std::string& by) {
  if (by == "part") return {};
  constexpr std::string_view k_triangles = "triangles=";
  std::size_t used = 0;
  if (by.starts_with(k_triangles)) try {
      const std::string number = by.substr(k_triangles.size());
      const long long triangles = std::stoll(number, &used);
      if (triangles > 0 && used == number.size()) return {static_cast<std::size_t>(triangles)};
    } catch (const std::exception&) {
    }
  throw UsageError("--by: '" + by + "' is neither part nor triangles=N");
}

Json run(const Options& options, VerbContext& context) {
  const SplitOptions by = split_options(options.by);
  const fs::path folder = options.folder;
  make_folder(folder);
  const BakeFileOptions wanted = options.arguments.options("scene.glb", context);
  const SplitResult result =
      split_bake(options.arguments.input, folder, options.arguments.rules(), wanted, by, context.progress);
  std::string manifest;
  double cost = 0, longest = 0;
  std::uint64_t bytes = 0;
  for (const BakeJob& job : result.jobs) {
    manifest += manifest_json(job, folder).dump() + "\n";
    cost += job.cost_seconds;
    longest = std::max(longest, job.cost_seconds);
    bytes += job.input_bytes;
  }
  save_arguments(*options.verb, folder);
  write_atomically(manifest_of(folder), manifest);
  context.console.print(way_line(result.way));
  context.console.print(shown_format(
      "{}: {} jobs of {} surfaces of {} parts, {:.1f} MB of inputs; about {:.0f} s of one core, the longest {:.1f} s\n",
      manifest_of(folder).string(), result.jobs.size(), result.surfaces, result.parts, static_cast<double>(bytes) / 1e6,
      cost, longest));
  context.console.print(shown_format("each job: papilla bake --job {}\nthen: papilla merge {} -o scene.glb\n",
                                     (folder / "ID").string(), folder.string()));
  return {{"folder", folder.string()}, {"jobs", result.jobs.size()}, {"surfaces", result.surfaces},
          {"parts", result.parts},     {"grains", result.grains},    {"input_bytes", bytes},
          {"cost_seconds", cost},      {"longest_seconds", longest}, {"way", way_json(result.way)},
          {"seconds", result.seconds}};
}

}  // namespace

void add_split(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(program,
                            {"split", "Divides a bake into jobs that many machines do side by side.",
                             "papilla split data/cockpit.step -m examples/materials.json -o jobs --by triangles=20000",
                             VerbInfo::AtDeadline::is_cancelled, VerbInfo::Remembers::yes},
                            [options](VerbContext& context) { return run(*options, context); });
  options->verb = verb;
  options->arguments.add_to(*verb);
  verb->get_option("SCENE")->required();
  verb->get_option("--materials")->required();
  writes_into(verb->add_option("-o,--output", options->folder, "Folder of the jobs, which all machines see"),
              {"manifest.jsonl", "bake.json"})
      ->type_name("DIR")
      ->required();
  verb->add_option("--by", options->by, "part: one job a part; triangles=N: parts together up to N triangles")
      ->type_name("part|triangles=N")
      ->capture_default_str();
}

}  // namespace papilla::app
