// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/scene_json.hpp"
#include "option_checks.hpp"
#include "options/scene_option.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/pipeline/pictures/uv_layout.hpp"
#include "scene_output.hpp"
#include "shown_format.hpp"
#include "text/scene_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string input, picture, csv, colored;
  bool histogram = false;
  double worst = 5;
  std::vector<std::string> gates;
  SceneOptions scene;
  double texture_px = 1024, uv_per_texture = 1;
  UvNormalization normalize = UvNormalization::scene;
};

/// NAME=VALUE, the name with dots for nested keys.
struct Gate {
  std::string name;
  double limit = 0;
};

Gate parse_gate(const std::string& text) {
  const std::size_t equals = text.find('=');
  Gate gate{text.substr(0, equals)};
  const char* end = text.data() + text.size();
  if (equals != std::string::npos) {
    const auto [rest, error] = std::from_chars(text.data() + equals + 1, end, gate.limit);
    if (error == std::errc() && rest == end && gate.limit == gate.limit) return gate;
  }
  throw UsageError("--fail-above '" + text + "': expected NAME=VALUE with a number");
}

double gated_value(const DistortionReport& distortion, const std::string& name) {
  for (const auto& [known, number] : distortion_numbers(distortion))
    if (known == name) return std::visit([](auto value) { return static_cast<double>(value); }, number);
  const auto numbers = distortion_numbers(distortion);
  std::vector<std::string_view> known;
  for (const auto& number : numbers) known.push_back(number.first);
  const std::string near = did_you_mean(name, known);
  throw UsageError("--fail-above: the report has no number '" + name + "'" +
                   (near.empty() ? "; it has, for example, symmetric_dirichlet.mean" : near));
}

Json check_gates(const std::vector<Gate>& gates, const DistortionReport& distortion, VerbContext& context) {
  Json failed = Json::array();
  for (const Gate& gate : gates) {
    const double value = gated_value(distortion, gate.name);
    if (value <= gate.limit) continue;
    context.exit_code = k_exit_gate;
    context.console.print(shown_format("FAILED: {} is {:.6g}, above {:.6g}\n", gate.name, value, gate.limit));
    failed.push_back({{"name", gate.name}, {"value", value}, {"limit", gate.limit}});
  }
  return failed;
}

/// The reports of single parts, when there are several.
Json parts_json(const Scene& scene, const MeasureOptions& options) {
  Json parts = Json::array();
  for (const Part& part : scene.parts) {
    Json entry = {{"name", shown_name(part)}};
    if (part.mesh.uv.empty())
      entry["without_uv"] = part.mesh.triangles.size();
    else
      entry.update(distortion_json(measure_distortion(part.mesh, part.mesh.uv, options)));
    parts.push_back(std::move(entry));
  }
  return parts;
}

Json run(const Options& options, VerbContext& context) {
  std::vector<Gate> gates;
  for (const std::string& text : options.gates) {
    gates.push_back(parse_gate(text));
    gated_value({}, gates.back().name);  // an unknown name is reported before the work
  }
  MeasureOptions measure;
  measure.normalize = options.normalize;
  measure.texture_px = {options.texture_px, options.texture_px};
  measure.uv_per_texture = {options.uv_per_texture, options.uv_per_texture};
  Scene scene = read_scene(options.input, options.scene.read_options(context.cache), context.progress);
  const SceneDistortion distortion = named_by(options.input, [&] { return measure_scene(scene, measure); });
  Json result = distortion_json(distortion.report);
  result["normalize"] = uv_normalization_name(options.normalize);
  result["worst_chart"] = worst_chart_json(scene, distortion);
  context.console.print(distortion_text(scene, distortion));
  if (!options.picture.empty())
    write_color_image(options.picture, draw_uv_layout(distortion.mesh.uv, distortion.report, {.worst = options.worst}));
  if (!options.csv.empty()) write_atomically(options.csv, distortion_csv(distortion));
  result["histogram"] = histogram_json(distortion.report);
  if (options.histogram) context.console.print(histogram_text(distortion.report));
  if (scene.parts.size() > 1) result["parts"] = parts_json(scene, measure);
  if (options.colored.empty()) {
    print_notes(scene, context.console);
  } else {
    colour_by_distortion(distortion, options.worst, scene);
    write_output(scene, options.colored, {}, context.console);
  }
  result["losses"] = scene.losses;
  result["warnings"] = scene.warnings;
  result["failed"] = check_gates(gates, distortion.report, context);
  return result;
}

}  // namespace

void add_measure(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"measure", "Measure the distortion of a file's texture coordinates, whoever made them.",
                "papilla measure part.obj --picture part.png --fail-above flipped=0 symmetric_dirichlet.mean=4.1"},
               [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("IN", options->input, "Mesh or glTF file"))->type_name("IN")->required();
  writes(verb->add_option("--picture", options->picture, "Draw the layout, coloured by symmetric Dirichlet distortion"))
      ->type_name("PNG");
  writes(verb->add_option("--colored", options->colored,
                          "Write the mesh, every triangle in the colour of its distortion: .glb, .ply, .obj"))
      ->type_name("FILE");
  verb->add_flag("--histogram", options->histogram, "Print how the area is spread over distortion");
  verb->add_option("--worst", options->worst, "Symmetric Dirichlet distortion at the end of the colours")
      ->check(in_range(4.0001, 1e6))
      ->capture_default_str();
  writes(verb->add_option("--csv", options->csv, "Write a line per triangle"))->type_name("FILE");
  verb->add_option("--fail-above", options->gates, "Exit with 1 when the number NAME of the report exceeds VALUE")
      ->type_name("NAME=VALUE");
  verb->add_option("--texture-px", options->texture_px, "Side of the texture in texels, for the texel density")
      ->check(in_range(1.0, 1e6))
      ->type_name("PX")
      ->capture_default_str();
  verb->add_option("--uv-per-texture", options->uv_per_texture,
                   "uv units that one texture covers: 1, or millimetres when uv are in millimetres")
      ->check(in_range(1e-9, 1e9))
      ->type_name("UV")
      ->capture_default_str();
  add_choice<UvNormalization>(*verb, "--normalize", options->normalize, uv_normalizations(),
                              "What shares the factor that makes areas in uv those in space: scene (default), part, "
                              "chart; none: uv count as mm");
  options->scene.add_to(*verb);
}

}  // namespace papilla::app
