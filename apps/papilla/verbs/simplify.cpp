// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/meshing/simplify.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "exit_code.hpp"
#include "papilla/pipeline/perception.hpp"
#include "papilla/pipeline/levels.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/simplify_scene.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "papilla/pipeline/shared_parts.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct SimplifyVerbOptions {
  std::string in, out;
  std::optional<double> tolerance_mm, ratio;
  std::optional<std::size_t> budget;
  LevelOptions levels;
  SimplifyOptions simplify;
  LeaveOutOptions leave_out;
  bool one_sided = false, merge_faces = false, keep_copies = false;
  SceneOptions read;
};

void check(const SimplifyVerbOptions& o) {
  if (!o.tolerance_mm && !o.ratio && !o.budget && !o.levels.asked())
    throw UsageError("simplify: one of --tolerance, --ratio, --budget, --lod or --lod-tolerances is needed");
  if (o.budget && (o.tolerance_mm || o.ratio))
    throw UsageError("simplify: --budget cannot be combined with --tolerance or --ratio");
  if (o.levels.asked() && !o.levels.as_nodes && std::filesystem::path(o.out).extension() != ".glb")
    throw UsageError("simplify: --output: '" + o.out +
                     "' must end in .glb to hold levels of detail; or give --lod-nodes");
}

SimplifyResult unchanged(const TriangleMesh& mesh) { return {mesh, mesh.triangles.size(), {}, {}, {}}; }

SimplifyResult simplify_part(const TriangleMesh& mesh, const SimplifyVerbOptions& o) {
  if (mesh.triangles.empty() || (!o.tolerance_mm && !o.ratio)) return unchanged(mesh);
  SimplifyOptions options = o.simplify;
  if (o.tolerance_mm) options.tolerance_mm = *o.tolerance_mm;
  if (o.ratio)
    options.target_triangles = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::ceil(*o.ratio * static_cast<double>(mesh.triangles.size()))));
  return simplify(mesh, options);
}

std::vector<SimplifyResult> simplify_parts(const Scene& scene, const SimplifyVerbOptions& o) {
  std::vector<SimplifyResult> results(scene.parts.size());
  oneapi::tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t i) {
    try {
      results[i] = simplify_part(scene.parts[i].mesh, o);
    } catch (const InvalidInput& error) {
      throw InvalidInput(o.in + ": part \"" + scene.parts[i].name + "\": " + error.what());
    }
  });
  return results;
}

Json part_json(const Part& part, const SimplifyResult& r) {
  Json trace = Json::array();
  for (const TraceSample& s : r.trace) trace.push_back({{"seconds", s.seconds}, {"error", s.error}});
  return {{"name", part.name},
          {"triangles_before", r.triangles_before},
          {"triangles_after", r.mesh.triangles.size()},
          {"max_deviation_mm", r.deviation.bound()},
          {"max_deviation_met_mm", r.deviation.value()},
          {"stop", to_string(r.stop)},
          {"trace", trace}};
}

void print_row(const Console& console, std::size_t before, std::size_t after, double deviation,
               const std::string& name) {
  console.print(fmt::format("{:>10} {:>10} {:>12.4g}  {}\n", before, after, deviation, name));
}

/// The deviations of all parts, in the result and on the console.
Json report_parts(const Scene& scene, const std::vector<SimplifyResult>& results, const Console& console, Json& json) {
  double deviation = 0, met = 0;
  Json parts = Json::array();
  console.print(fmt::format("{:>10} {:>10} {:>12}  part\n", "before", "after", "deviation mm"));
  for (std::size_t i = 0; i < results.size(); ++i) {
    const SimplifyResult& r = results[i];
    if (r.triangles_before == 0) continue;
    parts.push_back(part_json(scene.parts[i], r));
    deviation = std::max(deviation, r.deviation.bound());
    met = std::max(met, r.deviation.value());
    print_row(console, r.triangles_before, r.mesh.triangles.size(), r.deviation.bound(), scene.parts[i].name);
  }
  json["max_deviation_mm"] = deviation;
  json["max_deviation_met_mm"] = met;
  return parts;
}

Json simplify_file(VerbContext& context, SimplifyVerbOptions options) {
  const Stopwatch clock;
  check(options);
  options.simplify.two_sided = !options.one_sided;
  options.simplify.keep_faces = !options.merge_faces;
  Scene scene = read_scene(options.in, options.read.read_options(), context.progress);
  Json json = {{"triangles_before", drawn_triangles(scene)}};
  std::vector<SharedPart> shared;
  if (!options.keep_copies) shared = share_identical_parts(scene);
  json["identical_parts"] = shared_parts_json(shared, scene);
  if (options.leave_out.asked() || !options.leave_out.leave_out.empty()) {
    const LeaveOutResult perception = measure_perception(scene, options.leave_out, context.progress);
    json["perception"] = perception_json(scene, perception);
    context.console.print(left_out_table(scene, perception));
    leave_out(scene, perception);
  }

  std::vector<SimplifyResult> results;
  if (options.budget) {
    BudgetResult budget = fit_scene_to_budget(scene, *options.budget, options.simplify);
    json["budget"] = budget_json(scene, *options.budget, budget);
    results = std::move(budget.parts);
    if (!budget.reached)
      context.console.print(
          fmt::format("the budget of {} triangles can't be reached: borders, seams and features allow "
                      "no fewer than {}\n",
                      *options.budget, budget.triangles));
  } else {
    results = simplify_parts(scene, options);
  }
  const Json parts = report_parts(scene, results, context.console, json);
  double finest_mm = options.tolerance_mm.value_or(0);
  if (options.budget) finest_mm = json["budget"]["tolerance_mm"].get<double>();
  if (options.levels.asked())
    json["levels"] = add_levels(scene, results, options.levels, options.simplify, finest_mm, context.console);
  else
    for (std::size_t i = 0; i < results.size(); ++i) scene.parts[i].mesh = std::move(results[i].mesh);
  json["triangles_after"] = drawn_triangles(scene);
  print_row(context.console, json["triangles_before"].get<std::size_t>(), json["triangles_after"].get<std::size_t>(),
            json["max_deviation_mm"].get<double>(), "drawn in all");
  if (options.levels.as_nodes) levels_to_nodes(scene);
  write_output(scene, options.out, context.console);
  json["parts"] = parts;
  json["losses"] = scene.losses;
  json["warnings"] = scene.warnings;
  json["seconds"] = clock.seconds();
  json["output"] = options.out;
  return json;
}

void add_goals(CLI::App& verb, SimplifyVerbOptions& options) {
  verb.add_option("--tolerance", options.tolerance_mm, "Largest distance between input and result")
      ->type_name("MM")
      ->check(CLI::PositiveNumber);
  verb.add_option("--ratio", options.ratio, "Stop each part at this share of its triangles")
      ->type_name("R")
      ->check(CLI::Range(0.0, 1.0));
  verb.add_option("--budget", options.budget,
                  "Triangles that the scene may draw: the smallest common tolerance that meets it")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  options.levels.add_to(verb);
}

}  // namespace

void add_simplify(CLI::App& program) {
  auto options = std::make_shared<SimplifyVerbOptions>();
  CLI::App* verb = add_verb(program,
                            {"simplify", "Leave out triangles within a tolerance that is measured, both ways.",
                             "papilla simplify dash.glb -o light.glb --tolerance 0.1"},
                            [options](VerbContext& context) { return simplify_file(context, *options); });
  verb->add_option("in", options->in, "File to read")->type_name("IN")->required();
  verb->add_option("-o,--output", options->out, "GLB, OBJ, PLY, OFF or STL file to write")
      ->type_name("OUT")
      ->required();
  add_goals(*verb, *options);
  verb->add_option("--passes", options->simplify.passes, "1 is fastest, 4 leaves fewest triangles")
      ->type_name("N")
      ->check(CLI::Range(1, 6))
      ->capture_default_str();
  verb->add_option("--feature-angle", options->simplify.feature_angle_deg, "Sharper edges stay edges; 180: none")
      ->type_name("DEG")
      ->check(CLI::Range(0.0, 180.0))
      ->capture_default_str();
  verb->add_flag("--lock-border", options->simplify.lock_border, "Keep every border vertex");
  verb->add_flag("--merge-faces", options->merge_faces, "Simplify over the borders of CAD faces and file groups");
  verb->add_flag("--one-sided", options->one_sided, "Measure only from the result to the input");
  verb->add_flag("--keep-copies", options->keep_copies, "Do not make identical parts instances of one");
  options->leave_out.add_to(*verb);
  options->read.add_to(*verb);
}

}  // namespace papilla::app
