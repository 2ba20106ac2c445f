// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/meshing/repair.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "papilla/pipeline/part_statistics.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/deviation.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "papilla/pipeline/shared_parts.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct RepairVerbOptions {
  std::string in, out;
  RepairOptions repair;
  bool verify = false;
  bool keep_copies = false;
  SceneOptions read;
};

std::vector<RepairResult> repair_parts(Scene& scene, const RepairVerbOptions& options,
                                       const ProgressCallback& progress) {
  std::vector<RepairResult> results(scene.parts.size());
  RepairOptions repair_options = options.repair;
  if (scene.parts.size() == 1) repair_options.progress = progress;
  oneapi::tbb::parallel_for(std::size_t{0}, scene.parts.size(), [&](std::size_t i) {
    results[i] = repair(std::move(scene.parts[i].mesh), repair_options);
    scene.parts[i].mesh = std::move(results[i].mesh);
  });
  return results;
}

Json operations_json(const std::vector<RepairResult>& results) {
  const auto sum = [&](std::size_t RepairCounts::*count) {
    std::size_t total = 0;
    for (const RepairResult& r : results) total += r.counts.*count;
    return total;
  };
  return {{"welded_equal", sum(&RepairCounts::welded_equal)},
          {"welded_near", sum(&RepairCounts::welded_near)},
          {"repeated_corners", sum(&RepairCounts::repeated_corners)},
          {"collapsed_needles", sum(&RepairCounts::collapsed_needles)},
          {"flipped_caps", sum(&RepairCounts::flipped_caps)},
          {"pushed_apexes", sum(&RepairCounts::pushed_apexes)},
          {"duplicates", sum(&RepairCounts::duplicates)},
          {"opposites", sum(&RepairCounts::opposites)},
          {"walls", sum(&RepairCounts::walls)},
          {"t_junctions", sum(&RepairCounts::t_junctions)},
          {"border_slivers", sum(&RepairCounts::border_slivers)},
          {"reversed", sum(&RepairCounts::reversed)},
          {"parted_edges", sum(&RepairCounts::parted_edges)},
          {"added_vertices", sum(&RepairCounts::added_vertices)},
          {"stitched_gaps", sum(&RepairCounts::stitched_gaps)},
          {"filled_holes", sum(&RepairCounts::filled_holes)},
          {"added_triangles", sum(&RepairCounts::added_triangles)}};
}

Json deviations_json(const std::vector<RepairResult>& results) {
  const auto largest = [&](double RepairDeviations::*operation) {
    double deviation = 0;
    for (const RepairResult& r : results) deviation = std::max(deviation, r.deviations.*operation);
    return deviation;
  };
  return {{"weld", largest(&RepairDeviations::weld)},
          {"degenerate", largest(&RepairDeviations::degenerate)},
          {"t_junctions", largest(&RepairDeviations::t_junctions)},
          {"partings", largest(&RepairDeviations::partings)},
          {"stitches", largest(&RepairDeviations::stitches)}};
}

/// The largest distance between any part's surface before and after, both ways; an upper bound over all points.
double measured_deviation(const std::vector<TriangleMesh>& before, const Scene& after) {
  double deviation = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    if (!before[i].triangles.empty() && !after.parts[i].mesh.triangles.empty())
      deviation = std::max(deviation, surface_deviation(before[i], after.parts[i].mesh).bound());
  return deviation;
}

/// Back sides of double sheets are dropped, so what is left must be seen from both.
void show_both_sides(Scene& scene, const std::vector<RepairResult>& results) {
  for (std::size_t i = 0; i < results.size(); ++i)
    if (results[i].counts.opposites > results[i].counts.walls)
      for (const std::uint32_t m : scene.parts[i].materials)
        if (m < scene.materials.size()) scene.materials[m].double_sided = true;
}

Json repair_file(VerbContext& context, const RepairVerbOptions& options) {
  const Stopwatch clock;
  Scene scene = read_scene(options.in, options.read.read_options(), context.progress);
  const MeshStatistics before = total_statistics(part_statistics(scene, context.progress));
  std::vector<SharedPart> shared;
  if (!options.keep_copies) shared = share_identical_parts(scene);
  const Json identical = shared_parts_json(shared, scene);
  std::vector<TriangleMesh> originals;
  if (options.verify)
    for (const Part& part : scene.parts) originals.push_back(part.mesh);
  const std::vector<RepairResult> results = repair_parts(scene, options, context.progress);
  const MeshStatistics after = total_statistics(part_statistics(scene, context.progress));
  show_both_sides(scene, results);
  write_output(scene, options.out, context.console);

  double deviation = 0, tolerance = 0;
  std::vector<std::string> unsettled;
  for (std::size_t i = 0; i < results.size(); ++i) {
    deviation = std::max(deviation, results[i].max_deviation_mm);
    tolerance = std::max(tolerance, results[i].weld_tolerance_mm);
    if (!results[i].settled) unsettled.push_back(scene.parts[i].name);
  }
  context.console.print(header_row() + counters_row("before", before) + counters_row("after", after));
  context.console.print(fmt::format("largest deviation {:.3g} mm, weld tolerance {:.3g} mm\n", deviation, tolerance));
  std::optional<double> measured;
  if (options.verify) {
    measured = measured_deviation(originals, scene);
    const bool walls = std::any_of(results.begin(), results.end(), [](const auto& r) { return r.counts.walls > 0; });
    context.console.print(fmt::format("measured deviation at most {:.3g} mm, both ways{}\n", *measured,
                                      walls ? ", with the walls between solids that were dropped" : ""));
  }
  for (const std::string& name : unsettled) context.console.print("not settled: " + name + "\n");
  return {{"before", counters_json(before)},
          {"after", counters_json(after)},
          {"max_deviation_mm", deviation},
          {"measured_deviation_mm", measured ? Json(*measured) : Json()},
          {"weld_tolerance_mm", tolerance},
          {"operations", operations_json(results)},
          {"deviations_mm", deviations_json(results)},
          {"parts", scene.parts.size()},
          {"identical_parts", identical},
          {"unsettled", unsettled},
          {"losses", scene.losses},
          {"warnings", scene.warnings},
          {"seconds", clock.seconds()},
          {"output", options.out}};
}

}  // namespace

void add_repair(CLI::App& program) {
  auto options = std::make_shared<RepairVerbOptions>();
  CLI::App* verb = add_verb(program,
                            {"repair", "Make clean, oriented, manifold parts of whatever a file holds.",
                             "papilla repair scan.stl -o clean.glb"},
                            [options](VerbContext& context) { return repair_file(context, *options); });
  verb->add_option("in", options->in, "STL, OBJ, PLY, OFF, GLB or glTF file")->type_name("IN")->required();
  verb->add_option("-o,--output", options->out, "GLB, OBJ, PLY, OFF or STL file to write")
      ->type_name("OUT")
      ->required();
  verb->add_option("--weld", options->repair.weld_mm, "Weld tolerance; default: 1e-6 of each part's diagonal")
      ->type_name("MM")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--stitch", options->repair.stitch_mm,
                   "Widest gap between faces to close; default: 2e-4 of each part's diagonal, 0: none")
      ->type_name("MM")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--fill-holes", options->repair.fill_holes_mm, "Fill holes that fit into a box of this diagonal")
      ->type_name("MM")
      ->check(CLI::NonNegativeNumber);
  verb->add_flag("--verify", options->verify, "Measure the deviation from the input, not only bound it");
  verb->add_flag("--keep-copies", options->keep_copies, "Do not make identical parts instances of one");
  options->read.add_to(*verb);
}

}  // namespace papilla::app
