// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <map>
#include <memory>

#include "distortion_report.hpp"
#include "exit_code.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/io/image_file.hpp"
#include "pictures/uv_layout.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "unwrap/unwrap.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string input, output, trace, picture;
  std::vector<double> tile{0, 0};
  SceneOptions scene;
  UnwrapOptions unwrap;
};

std::string trace_csv(const Trace& trace) {
  std::string csv = "seconds,error\n";
  for (const TraceSample& s : trace) csv += fmt::format("{:.9g},{:.9g}\n", s.seconds, s.error);
  return csv;
}

Json parts_json(const Scene& scene, const UnwrapReport& report) {
  Json parts = Json::array();
  for (std::size_t p = 0; p < scene.parts.size(); ++p) {
    const UnwrappedPart& part = report.parts[p];
    Json notes = Json::array();
    for (const ChartNote& note : part.flattening.notes) notes.push_back(note.reason);
    parts.push_back({{"name", scene.parts[p].name},
                     {"triangles", scene.parts[p].mesh.triangles.size()},
                     {"charts", part.flattening.charts.count},
                     {"seam_length_mm", part.flattening.charts.seam_length_mm},
                     {"grain_continued_mm", part.grain_continued_mm},
                     {"notes", std::move(notes)},
                     {"failure", part.failure.empty() ? Json() : Json(part.failure)}});
  }
  return parts;
}

/// What was not done as asked, a line each.
std::string remarks(const UnwrapReport& report) {
  std::string text;
  for (const UnwrappedPart& part : report.parts) {
    if (!part.failure.empty()) text += "not unwrapped: " + part.failure + "\n";
    if (!part.flattening.notes.empty())
      text += fmt::format("{} charts fell back to planar projection, the first: {}\n", part.flattening.notes.size(),
                          part.flattening.notes.front().reason);
  }
  return text;
}

void check_usage(const Options& options) {
  if (options.unwrap.method == UnwrapMethod::triplanar && options.unwrap.charts == ChartSource::keep)
    throw UsageError("--charts keep: triplanar makes its own charts");
  const std::filesystem::path output(options.output);
  if (output.extension() == ".stl" || output.extension() == ".STL")
    throw UsageError("-o " + options.output + ": STL has no place for texture coordinates");
}

/// unwrap_scene() with the file's name in front of what it throws.
UnwrapReport unwrap_named(const std::string& file, Scene& scene, const UnwrapOptions& options,
                          const Progress& progress) {
  try {
    return unwrap_scene(scene, options, progress);
  } catch (const InvalidInput& error) {
    throw InvalidInput(file + ": " + error.what());
  } catch (const SolverFailure& error) {
    throw SolverFailure(file + ": " + error.what());
  }
}

Json run(const Options& options, VerbContext& context) {
  check_usage(options);
  Scene scene = read_scene(options.input, options.scene.read_options(), context.progress);
  UnwrapOptions unwrap = options.unwrap;
  unwrap.tile_mm = {options.tile[0], options.tile[1]};
  const UnwrapReport report = unwrap_named(options.input, scene, unwrap, context.progress);
  const SceneDistortion distortion =
      measure_scene(scene, {}, [&](std::size_t p) { return report.parts[p].failure.empty(); });
  write_output(scene, options.output, context.console);
  if (!options.trace.empty()) write_atomically(options.trace, trace_csv(report.trace));
  if (!options.picture.empty())
    write_color_image(options.picture, draw_uv_layout(distortion.mesh.uv, distortion.report));

  const std::string method = unwrap.method == UnwrapMethod::lscm ? "lscm" : "triplanar";
  context.console.print(fmt::format("{}: {} charts in {:.3f} s\n", method, report.charts, report.seconds.total) +
                        distortion_text(distortion.report) + remarks(report));
  return {{"method", method},
          {"charts", report.charts},
          {"stop", to_string(report.stop)},
          {"seconds",
           {{"segment", report.seconds.segment},
            {"solve", report.seconds.solve},
            {"pack", report.seconds.pack},
            {"total", report.seconds.total}}},
          {"fill_rate", report.fill_rate},
          {"distortion", distortion_json(distortion.report)},
          {"parts", parts_json(scene, report)},
          {"losses", scene.losses}};
}

template <class Value>
CLI::Option* add_choice(CLI::App* verb, const std::string& name, Value& value,
                        const std::map<std::string, Value>& choices, const std::string& help) {
  return verb->add_option(name, value, help)
      ->transform(CLI::CheckedTransformer(choices, CLI::ignore_case).description(""));
}

}  // namespace

void add_unwrap(CLI::App& program) {
  auto options = std::make_shared<Options>();
  UnwrapOptions& unwrap = options->unwrap;
  CLI::App* verb = add_verb(program,
                            {"unwrap", "Make charts and texture coordinates in millimetres.",
                             "papilla unwrap part.stl -o part.glb --method lscm --picture part.png"},
                            [options](VerbContext& context) { return run(*options, context); });
  verb->add_option("IN", options->input, "Mesh, CAD or glTF file")->required();
  verb->add_option("-o,--output", options->output, "File with texture coordinates: .glb, .obj")->required();
  add_choice<UnwrapMethod>(verb, "--method", unwrap.method,
                           {{"triplanar", UnwrapMethod::triplanar}, {"lscm", UnwrapMethod::lscm}},
                           "triplanar: projection along the axes; lscm (default): least squares conformal maps");
  add_choice<ChartSource>(verb, "--charts", unwrap.charts,
                          {{"auto", ChartSource::automatic}, {"keep", ChartSource::keep}},
                          "Of lscm. auto (default): segment the surface; keep: each component is one chart");
  add_choice<LscmSolver>(verb, "--solver", unwrap.solver,
                         {{"cgal", LscmSolver::cgal}, {"hermitian", LscmSolver::hermitian}},
                         "Of lscm: cgal (default) or the faster hermitian");
  verb->add_option("--feature-angle", unwrap.segmentation.feature_angle_deg, "Edges bent by more degrees part charts")
      ->check(CLI::Range(1.0, 180.0))
      ->type_name("DEG")
      ->capture_default_str();
  verb->add_option("--seam-cost", unwrap.segmentation.seam_cost,
                   "What seams cost against distortion: 0.01 cuts generously, 0.5 hardly ever")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  add_choice<UvLayout>(verb, "--layout", unwrap.layout, {{"atlas", UvLayout::atlas}, {"tile", UvLayout::tile}},
                       "atlas (default): no two charts overlap; tile: the grain goes on over seams");
  verb->add_option("--tile", options->tile, "Size of the grain's repeat: charts keep its phase")
      ->expected(2)
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("MM");
  verb->add_option("--gutter", unwrap.gutter_mm, "Least distance of charts in the atlas; default: 0.5 % of its side")
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("MM");
  verb->add_option("--trace", options->trace, "Write error over run time as CSV: seconds,error")->type_name("FILE");
  verb->add_option("--picture", options->picture, "Draw the layout, coloured by distortion")->type_name("PNG");
  options->scene.add_to(*verb);
}

}  // namespace papilla::app
