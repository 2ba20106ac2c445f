// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/scene_json.hpp"
#include "option_checks.hpp"
#include "options/output_option.hpp"
#include "options/perception_option.hpp"
#include "options/scene_option.hpp"
#include "papilla/core/progress_until.hpp"
#include "papilla/pipeline/level_scenes.hpp"
#include "scene_output.hpp"
#include "shown_format.hpp"
#include "text/scene_text.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

constexpr double k_writing_s = 1e-6;  ///< A triangle: kept of the time that there is.

struct Options {
  std::string in, out;
  SimplifySceneOptions simplify;
  PerceptionOption perception;
  bool one_sided = false, merge_faces = false, strict = false;
  bool as_nodes = false, as_files = false;  ///< Levels as nodes or as files instead of MSFT_lod.
  SceneOptions read;
  OutputOptions stored;
};

void check(const Options& o) {
  const SimplifySceneOptions& s = o.simplify;
  if (!s.tolerance_mm && !s.ratio && !s.budget && !s.levels.asked())
    throw UsageError("simplify: one of --tolerance, --ratio, --budget, --lod or --lod-tolerances is needed");
  if (s.budget && (s.tolerance_mm || s.ratio))
    throw UsageError("simplify: --budget cannot be combined with --tolerance or --ratio");
  if (!s.levels.asked() && (o.as_nodes || o.as_files))
    throw UsageError("simplify: --lod-nodes and --lod-files need --lod or --lod-tolerances");
  if (s.levels.asked() && !o.as_nodes && !o.as_files && !is_gltf_file(o.out))
    throw UsageError("simplify: --output: '" + o.out +
                     "' must end in .glb or .gltf to hold levels of detail; or give --lod-nodes or --lod-files");
  double last = s.tolerance_mm.value_or(0);
  for (const double tolerance : s.levels.tolerances_mm) {
    if (!(tolerance > last))
      throw UsageError(fmt::format("simplify: --lod-tolerances: {} does not exceed {} mm", tolerance, last));
    last = tolerance;
  }
}

/// Writes OUT.lod1.glb, OUT.lod2.glb, ... and takes the levels from the scene. @returns what they are.
Json write_level_files(Scene& scene, std::span<const LevelReport> levels, const std::string& out,
                       const WriteOptions& write, const Console& console) {
  Json files = Json::array();
  const std::filesystem::path path = out;
  for (const double tolerance : level_tolerances(levels)) {
    LevelScene level = scene_of_level(scene, levels, tolerance);
    const std::string file =
        std::filesystem::path(path)
            .replace_extension(fmt::format(".lod{}{}", files.size() + 1, path.extension().string()))
            .string();
    level.scene.warnings.clear();
    level.scene.losses.clear();  // They are those of the scene, which tells them.
    const Json stored = write_output(level.scene, file, write, console);
    const std::size_t triangles = drawn_triangles(level.scene);
    console.print(shown_format("{}: {} triangles within {:.3g} mm, below {:.3g} of the picture's height\n", file,
                               triangles, tolerance, level.screen_coverage));
    files.push_back({{"file", file},
                     {"level", files.size() + 1},
                     {"tolerance_mm", tolerance},
                     {"screen_coverage", level.screen_coverage},
                     {"triangles", triangles},
                     {"stored", stored}});
  }
  for (Part& part : scene.parts) part.levels.clear();
  return files;
}

Json run(const Options& options, VerbContext& context) {
  check(options);
  const WriteOptions write = options.stored.write_options(options.out);
  SimplifySceneOptions wanted = options.simplify;
  wanted.perception = options.perception.options();
  wanted.simplify.two_sided = !options.one_sided;
  wanted.simplify.keep_faces = !options.merge_faces;
  wanted.cache = context.cache;
  Scene scene = read_scene(options.in, options.read.read_options(context.cache),
                           progress_until(context.progress, context.read_deadline));
  wanted.simplify.deadline = context.deadline.earlier_by(k_writing_s * static_cast<double>(drawn_triangles(scene)));
  SimplifySceneResult result =
      named_by(options.in, [&] { return simplify_scene(std::move(scene), wanted, context.progress); });
  if (options.strict && result.budget && !result.budget->reached)
    throw SolverFailure(fmt::format("{}: the budget of {} triangles can't be reached: {} are left within {:.3g} mm",
                                    options.in, *wanted.budget, result.budget->triangles, result.budget->tolerance_mm));
  context.console.print(simplify_text(result, wanted));
  Json json = simplify_json(result, wanted);
  if (options.as_nodes) levels_to_nodes(result.scene);
  if (options.as_files)
    json["lod_files"] = write_level_files(result.scene, result.levels, options.out, write, context.console);
  json["stored"] = write_output(result.scene, options.out, write, context.console);
  json["losses"] = result.scene.losses;
  json["output"] = options.out;
  return json;
}

void add_goals(CLI::App& verb, Options& options) {
  SimplifySceneOptions& simplify = options.simplify;
  LevelOptions& levels = simplify.levels;
  verb.add_option("--tolerance", simplify.tolerance_mm, "Largest distance between input and result")
      ->type_name("MM")
      ->check(positive());
  verb.add_option("--ratio", simplify.ratio, "Stop each part at this share of its triangles")
      ->type_name("R")
      ->check(in_range(0.0, 1.0));
  verb.add_option("--budget", simplify.budget,
                  "Triangles that the scene may draw: the smallest common tolerance that meets it")
      ->type_name("N")
      ->check(positive());
  auto* number =
      verb.add_option("--lod", levels.count,
                      "So many coarser levels, each within four times the tolerance of the last; one that has not a "
                      "tenth fewer triangles is left out, and said so")
          ->type_name("N")
          ->check(in_range(1, 8));
  verb.add_option("--lod-tolerances", levels.tolerances_mm, "Coarser levels within these ascending tolerances")
      ->type_name("MM,MM,...")
      ->delimiter(',')
      ->check(positive())
      ->excludes(number);
  auto* const nodes =
      verb.add_flag("--lod-nodes", options.as_nodes, "Levels as nodes NAME_LOD0, NAME_LOD1, ... instead of MSFT_lod");
  verb.add_flag("--lod-files", options.as_files,
                "Levels as files OUT.lod1.glb, OUT.lod2.glb, ... instead of MSFT_lod, in any format that is written")
      ->excludes(nodes);
}

}  // namespace

void add_simplify(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(
      program,
      {"simplify", "Leave out triangles within a tolerance that is measured, both ways.",
       "papilla simplify dash.glb -o light.glb --tolerance 0.1", VerbInfo::AtDeadline::ends, VerbInfo::Remembers::yes},
      [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("in", options->in, "File to read"))->type_name("IN")->required();
  writes(verb->add_option("-o,--output", options->out, "GLB, OBJ, PLY, OFF or STL file to write"))
      ->type_name("OUT")
      ->required();
  add_goals(*verb, *options);
  verb->add_option("--passes", options->simplify.simplify.passes, "1 is fastest, 4 leaves fewest triangles")
      ->type_name("N")
      ->check(in_range(1, 6))
      ->capture_default_str();
  verb->add_option("--feature-angle", options->simplify.simplify.feature_angle_deg,
                   "Sharper edges stay edges; 180: none")
      ->type_name("DEG")
      ->check(in_range(0.0, 180.0))
      ->capture_default_str();
  verb->add_flag("--strict", options->strict, "Write nothing, and end with 4, when the budget can't be reached");
  verb->add_flag("--lock-border", options->simplify.simplify.lock_border, "Keep every border vertex");
  verb->add_flag("--merge-faces", options->merge_faces, "Simplify over the borders of CAD faces and file groups");
  verb->add_flag("--one-sided", options->one_sided, "Measure only from the result to the input");
  verb->add_flag("--keep-copies", options->simplify.keep_copies, "Do not make identical parts instances of one");
  options->perception.add_to(*verb);
  options->read.add_to(*verb);
  options->stored.add_to(*verb);
}

}  // namespace papilla::app
