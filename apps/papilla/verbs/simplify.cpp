// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/meshing/simplify.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "exit_code.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/levels_of_detail.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct SimplifyVerbOptions {
  std::string in, out;
  std::optional<double> tolerance_mm, ratio;
  std::optional<std::size_t> max_triangles;
  std::vector<double> lod_mm;
  SimplifyOptions simplify;
  bool one_sided = false, merge_faces = false;
  SceneOptions read;
};

/// A part's levels, finest first; one without --lod.
using PartLevels = std::vector<SimplifyResult>;

void check(const SimplifyVerbOptions& o) {
  if (!o.tolerance_mm && !o.ratio && !o.max_triangles && o.lod_mm.empty())
    throw UsageError("simplify: one of --tolerance, --ratio, --max-triangles or --lod is needed");
  if (o.max_triangles && (o.tolerance_mm || o.ratio || !o.lod_mm.empty()))
    throw UsageError("simplify: --max-triangles cannot be combined with --tolerance, --ratio or --lod");
  if (o.ratio && !o.lod_mm.empty()) throw UsageError("simplify: --ratio cannot be combined with --lod");
}

PartLevels simplify_part(const TriangleMesh& mesh, const SimplifyVerbOptions& o) {
  SimplifyOptions options = o.simplify;
  if (!o.lod_mm.empty()) {
    std::vector<double> tolerances = o.lod_mm;
    if (o.tolerance_mm) tolerances.insert(tolerances.begin(), *o.tolerance_mm);
    PartLevels levels = levels_of_detail(mesh, tolerances, options);
    if (!o.tolerance_mm) levels.insert(levels.begin(), SimplifyResult{mesh, mesh.triangles.size(), {}, {}, {}});
    return levels;
  }
  if (o.tolerance_mm) options.tolerance_mm = *o.tolerance_mm;
  if (o.ratio)
    options.target_triangles = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::ceil(*o.ratio * static_cast<double>(mesh.triangles.size()))));
  PartLevels levels;
  levels.push_back(simplify(mesh, options));
  return levels;
}

std::vector<PartLevels> simplify_parts(const Scene& scene, const SimplifyVerbOptions& o) {
  std::vector<PartLevels> results(scene.parts.size());
  if (!o.max_triangles) {
    oneapi::tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t i) {
      try {
        results[i] = simplify_part(scene.parts[i].mesh, o);
      } catch (const InvalidInput& error) {
        throw InvalidInput(o.in + ": part \"" + scene.parts[i].name + "\": " + error.what());
      }
    });
    return results;
  }
  std::vector<BudgetPart> parts;
  for (const Part& part : scene.parts) parts.push_back({&part.mesh, 1, 0});
  for (const Instance& instance : instances(scene)) ++parts[instance.part].instances;
  BudgetResult budget = simplify_to_budget(parts, *o.max_triangles, o.simplify);
  for (std::size_t i = 0; i < results.size(); ++i) results[i].push_back(std::move(budget.parts[i]));
  return results;
}

/// Each node that shows a part keeps its place and gets one child a level, named NAME_LOD0, NAME_LOD1, ...
void add_levels(Scene& scene, const std::vector<PartLevels>& results) {
  const std::size_t parts = results.size(), nodes = scene.nodes.size();
  const std::size_t levels = parts == 0 ? 0 : results.front().size();
  for (std::size_t level = 1; level < levels; ++level)
    for (std::size_t i = 0; i < parts; ++i) {
      Part part = scene.parts[i];
      part.mesh = results[i][level].mesh;
      part.name += fmt::format("_LOD{}", level);
      part.id += fmt::format("_LOD{}", level);
      scene.parts.push_back(std::move(part));
    }
  for (std::size_t n = 0; n < nodes && levels > 1; ++n) {
    if (!scene.nodes[n].part) continue;
    const std::uint32_t part = *scene.nodes[n].part;
    scene.nodes[n].part.reset();
    for (std::size_t level = 0; level < levels; ++level) {
      Node child;
      child.name =
          fmt::format("{}_LOD{}", scene.nodes[n].name.empty() ? scene.parts[part].name : scene.nodes[n].name, level);
      child.part = static_cast<std::uint32_t>(part + level * parts);
      scene.nodes[n].children.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
      scene.nodes.push_back(std::move(child));
    }
  }
}

Json level_json(const SimplifyResult& r) {
  Json trace = Json::array();
  for (const TraceSample& s : r.trace) trace.push_back({{"seconds", s.seconds}, {"error", s.error}});
  return {{"triangles_before", r.triangles_before},
          {"triangles_after", r.mesh.triangles.size()},
          {"max_deviation_mm", r.deviation.bound()},
          {"max_deviation_met_mm", r.deviation.value()},
          {"stop", to_string(r.stop)},
          {"trace", trace}};
}

Json simplify_file(VerbContext& context, SimplifyVerbOptions options) {
  const Stopwatch clock;
  check(options);
  options.simplify.two_sided = !options.one_sided;
  options.simplify.keep_faces = !options.merge_faces;
  Scene scene = read_scene(options.in, options.read.read_options(), context.progress);
  std::vector<PartLevels> results = simplify_parts(scene, options);

  std::size_t before = 0, after = 0;
  double deviation = 0, met = 0;
  Json parts = Json::array();
  context.console.print(fmt::format("{:>10} {:>10} {:>12}  part\n", "before", "after", "deviation mm"));
  for (std::size_t i = 0; i < results.size(); ++i) {
    const SimplifyResult& r = results[i].front();
    Json row{{"name", scene.parts[i].name}};
    row.update(level_json(r));
    for (std::size_t level = 1; level < results[i].size(); ++level)
      row["levels"].push_back(level_json(results[i][level]));
    parts.push_back(std::move(row));
    before += r.triangles_before;
    after += r.mesh.triangles.size();
    deviation = std::max(deviation, r.deviation.bound());
    met = std::max(met, r.deviation.value());
    for (const SimplifyResult& level : results[i])
      context.console.print(fmt::format("{:>10} {:>10} {:>12.4g}  {}\n", level.triangles_before,
                                        level.mesh.triangles.size(), level.deviation.bound(), scene.parts[i].name));
  }
  context.console.print(fmt::format("{:>10} {:>10} {:>12.4g}  total\n", before, after, deviation));
  for (std::size_t i = 0; i < results.size(); ++i) scene.parts[i].mesh = results[i].front().mesh;
  add_levels(scene, results);
  write_output(scene, options.out, context.console);
  return {{"triangles_before", before},  {"triangles_after", after}, {"max_deviation_mm", deviation},
          {"max_deviation_met_mm", met}, {"parts", parts},           {"losses", scene.losses},
          {"seconds", clock.seconds()},  {"output", options.out}};
}

}  // namespace

void add_simplify(CLI::App& program) {
  auto options = std::make_shared<SimplifyVerbOptions>();
  CLI::App* verb = add_verb(program,
                            {"simplify", "Leave out triangles within a tolerance that is measured, both ways.",
                             "papilla simplify dash.glb -o light.glb --tolerance 0.1"},
                            [options](VerbContext& context) { return simplify_file(context, *options); });
  verb->add_option("in", options->in, "File to read")->type_name("IN")->required();
  verb->add_option("-o,--output", options->out, "GLB, OBJ, PLY, OFF or STL file to write")->type_name("OUT")->required();
  verb->add_option("--tolerance", options->tolerance_mm, "Largest distance between input and result")
      ->type_name("MM")
      ->check(CLI::PositiveNumber);
  verb->add_option("--ratio", options->ratio, "Stop each part at this share of its triangles")
      ->type_name("R")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--max-triangles", options->max_triangles, "Triangles that the whole scene may draw")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  verb->add_option("--lod", options->lod_mm,
                   "Coarser levels within these ascending tolerances, as nodes NAME_LOD0, NAME_LOD1, ...")
      ->type_name("MM,MM,...")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
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
  options->read.add_to(*verb);
}

}  // namespace papilla::app
