// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/scene_json.hpp"
#include "options/output_option.hpp"
#include "options/scene_option.hpp"
#include "options/side_option.hpp"
#include "options/unwrap_option.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/progress_until.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/pipeline/pictures/uv_layout.hpp"
#include "scene_output.hpp"
#include "shown_format.hpp"
#include "text/scene_text.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string input, output, trace, picture;
  SceneOptions scene;
  OutputOptions stored;
  SideOption sides;
  UnwrapOption unwrap;
  bool strict = false;
};

/// @throws SolverFailure naming the first part that does not keep the bound.
void require_bounds(const std::string& input, const UnwrapResult& result) {
  for (std::size_t p = 0; p < result.parts.size(); ++p)
    if (const auto& bound = result.parts[p].bound; bound && !bound->kept)
      throw SolverFailure(fmt::format("{}: part '{}': the bound of {} can't be kept: {:.6g} was reached", input,
                                      shown_name(result.scene.parts[p]), distortion_bound_name(bound->bound),
                                      bound->distortion));
}

std::string trace_csv(const Trace& trace) {
  std::string csv = "seconds,error\n";
  for (const TraceSample& s : trace) csv += fmt::format("{:.9g},{:.9g}\n", s.seconds, s.error);
  return csv;
}

Json run(const Options& options, VerbContext& context) {
  if (const auto extension = std::filesystem::path(options.output).extension();
      extension == ".stl" || extension == ".STL" || extension == ".off" || extension == ".OFF")
    throw UsageError("-o " + options.output + ": " + extension.string() + " has no place for texture coordinates");
  const WriteOptions write = options.stored.write_options(options.output);
  UnwrapOptions unwrap = options.unwrap.options();
  unwrap.sides = options.sides.options(options.output);
  unwrap.method.deadline = context.deadline;
  unwrap.method.cache = context.cache;
  Scene scene = read_scene(options.input, options.scene.read_options(context.cache),
                           progress_until(context.progress, context.read_deadline));
  check_held_parts(unwrap.method, options.input, scene);
  UnwrapResult result =
      named_by(options.input, [&] { return unwrap_scene(std::move(scene), unwrap, context.progress); });
  if (options.strict) require_bounds(options.input, result);
  const Json stored = write_output(result.scene, options.output, write, context.console);
  const Scene written = read_scene(options.output);  // what is said is what is written, in the file's precision
  MeasureOptions measure;
  measure.overlap = !context.deadline.passed();
  const SceneDistortion distortion = measure_scene(written, measure);
  if (!options.trace.empty()) write_atomically(options.trace, trace_csv(result.trace));
  if (!options.picture.empty())
    write_color_image(options.picture, draw_uv_layout(distortion.mesh.uv, distortion.report));
  const std::string method = unwrap_method_name(unwrap.method.method);
  context.console.print(shown_format("{}: {} charts in {:.3f} s\n", method, result.charts, result.seconds.total) +
                        distortion_text(written, distortion) + unwrap_remarks(result));
  Json json{{"method", method}};
  json.update(unwrap_json(result, unwrap, distortion));
  json["worst_chart"] = worst_chart_json(written, distortion);
  json["stored"] = stored;
  return json;
}

}  // namespace

void add_unwrap(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(
      program,
      {"unwrap", "Make charts and texture coordinates in millimetres.",
       "papilla unwrap part.stl -o part.glb --picture part.png", VerbInfo::AtDeadline::ends, VerbInfo::Remembers::yes},
      [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("IN", options->input, "Mesh, CAD or glTF file"))->type_name("IN")->required();
  writes(verb->add_option("-o,--output", options->output, "File with texture coordinates: .glb, .obj"))
      ->type_name("OUT")
      ->required();
  options->unwrap.add_to(*verb);
  writes(verb->add_option("--trace", options->trace, "Write error over run time as CSV: seconds,error"))
      ->type_name("FILE");
  writes(verb->add_option("--picture", options->picture, "Draw the layout, coloured by distortion"))->type_name("PNG");
  verb->add_flag("--strict", options->strict, "Write nothing, and end with 4, when --max-distortion can't be kept")
      ->needs("--max-distortion");
  options->sides.add_to(*verb);
  options->scene.add_to(*verb);
  options->stored.add_to(*verb);
}

}  // namespace papilla::app
