// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/height_from_image.hpp"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>

#include "exit_code.hpp"
#include "papilla/pipeline/height_file.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/normal_map.hpp"
#include "papilla/pipeline/pictures/relief.hpp"
#include "papilla/pipeline/pictures/texture_plots.hpp"
#include "options/vector_option.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Arguments {
  std::string image, output, normal, pictures;
  std::string method = "auto", light = "auto", periodic = "auto", roughness = "whole", cut = "none";
  double rate_hz = 1000, speed_mm_per_s = 100;
  bool variants = false, alternative = false;
  HeightOptions options;
};

Json to_json(const HeightResult& result) {
  Json json{{"method", to_string(result.method)}, {"reason", result.reason}};
  const bool lit = result.method != HeightMethod::intensity;
  json["light"] = lit ? Json{result.light.x, result.light.y, result.light.z} : Json(nullptr);
  json["light_estimated"] = result.light_estimated;
  json["light_coherence"] = result.light_estimated ? Json(result.light_coherence) : Json(nullptr);
  json["size"] = {result.map.width, result.map.height};
  json["pitch_mm"] = result.map.pitch_mm_x > 0 ? Json(result.map.pitch_mm_x) : Json(nullptr);
  json["depth_mm"] = result.depth_mm;
  json["rms_mm"] = result.rms_mm;
  json["periodic"] = result.map.periodic;
  json["roughness"] = {{"source", to_string(result.roughness)}, {"rms_mm", result.roughness_rms_mm}};
  json["shortest_wavelength_mm"] =
      result.shortest_wavelength_mm > 0 ? Json(result.shortest_wavelength_mm) : Json(nullptr);
  json["guessed_share"] = result.guessed_share;
  json["tile"] = nullptr;
  if (result.tile)
    json["tile"] = {{"size", {result.tile->width, result.tile->height}},
                    {"lattice_vectors", result.tile->combination},
                    {"strain", result.tile->strain}};
  json["measured"] = result.measured;
  json["assumed"] = result.assumed;
  json["stop"] = to_string(result.stop);
  json["trace"] = Json::array();
  for (const TraceSample& sample : result.trace)
    json["trace"].push_back({{"seconds", sample.seconds}, {"error", sample.error}});
  return json;
}

void print(const Console& console, const Arguments& arguments, const HeightResult& result) {
  console.print(fmt::format("{}: {} ({})\n", arguments.image, to_string(result.method), result.reason));
  if (result.light_estimated)
    console.print(
        fmt::format("light      {:.2f}, {:.2f}, {:.2f}: azimuth estimated (coherence {:.2f}), elevation assumed\n",
                    result.light.x, result.light.y, result.light.z, result.light_coherence));
  console.print(fmt::format("relief     {} x {} samples, depth {:.3f} mm, rms {:.4f} mm, {}\n", result.map.width,
                            result.map.height, result.depth_mm, result.rms_mm,
                            result.map.periodic ? "tiles" : "does not tile"));
  if (result.map.pitch_mm_x > 0)
    console.print(fmt::format("pitch      {:.4f} mm a pixel\n", result.map.pitch_mm_x));
  else
    console.print("pitch      unknown: the file has no resolution, give --pitch\n");
  if (result.tile)
    console.print(fmt::format("tile       of the lattice, strain {:.2f} %\n", 100 * result.tile->strain));
  if (!result.trace.empty())
    console.print(fmt::format("shading    residual {:.4f} after {} steps, {:.2f} s, {}\n", result.trace.back().error,
                              result.trace.size(), result.trace.back().seconds, to_string(result.stop)));
  if (result.roughness != HeightRoughness::whole)
    console.print(fmt::format("roughness  {}, rms {:.4f} mm\n", to_string(result.roughness), result.roughness_rms_mm));
  if (result.guessed_share > 0)
    console.print(fmt::format("guessed    {:.0f} % of the slopes run across the light\n", 100 * result.guessed_share));
  for (const std::string& what : result.measured) console.print(fmt::format("measured   {}\n", what));
  for (const std::string& what : result.assumed) console.print(fmt::format("assumed    {}\n", what));
  console.print(fmt::format("written    {}\n", arguments.output));
}

/// The relief as the eye would see it, its opposite, and its cross-section.
Json write_pictures(const std::string& folder, HeightMap map, const Console& console) {
  namespace fs = std::filesystem;
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw IoError(folder + ": " + failure.message());
  const std::string section = (fs::path(folder) / "section.svg").string();
  const bool has_section = write_plot(section, section_plot(map));
  const double pitch_mm = map.pitch_mm_x;
  if (!(pitch_mm > 0)) map.pitch_mm_x = map.pitch_mm_y = 1;  // Slopes of a guess: the exaggeration sets them.
  Json json = Json::array();
  const auto draw = [&](const char* name, const HeightMap& relief) {
    const std::string file = (fs::path(folder) / fmt::format("{}.png", name)).string();
    double exaggeration = 1;
    ColorImage picture = draw_relief(relief, exaggeration);
    const double bar_mm = draw_scale_bar(picture, pitch_mm);
    write_color_image(file, picture);
    console.print(fmt::format("written    {}, heights times {:.3g}{}\n", file, exaggeration,
                              bar_mm > 0 ? fmt::format(", the bar is {:g} mm", bar_mm) : ""));
    json.push_back({{"name", name},
                    {"file", file},
                    {"exaggeration", exaggeration},
                    {"scale_bar_mm", bar_mm > 0 ? Json(bar_mm) : Json(nullptr)}});
  };
  draw("relief", map);
  draw("relief-opposite", opposite_relief(map));
  console.print(has_section ? fmt::format("written    {}\n", section)
                            : fmt::format("not drawn  {}: gnuplot is not installed\n", section));
  if (has_section) json.push_back({{"name", "section"}, {"file", section}});
  return json;
}

/// FILE-suffix.ext beside FILE.ext.
std::string beside(const std::string& output, std::string_view suffix) {
  const std::filesystem::path path = output;
  return (path.parent_path() / fmt::format("{}-{}{}", path.stem().string(), suffix, path.extension().string()))
      .string();
}

/// The relief that the opposite light would make of the same picture, beside the output.
Json write_alternative(const std::string& output, const HeightResult& result, const Console& console) {
  const std::string file = beside(output, "opposite");
  write_height_file(file, opposite_relief(result.map));
  console.print(fmt::format("written    {}: the same picture under the opposite light\n", file));
  const bool lit = result.method != HeightMethod::intensity;
  return {{"file", file},
          {"light", lit ? Json{-result.light.x, -result.light.y, result.light.z} : Json(nullptr)},
          {"reason", lit ? "light from the opposite azimuth on the inverted relief gives the same picture"
                         : "nothing in the picture says whether bright is high"}};
}

/// The same relief twice and four times as deep, beside the output.
Json write_variants(const std::string& output, const HeightMap& map, const Console& console) {
  Json json = Json::array();
  for (const int factor : {2, 4}) {
    HeightMap deeper = map;
    for (float& height : deeper.mm) height *= static_cast<float>(factor);
    const std::string file = beside(output, fmt::format("x{}", factor));
    write_height_file(file, deeper);
    console.print(fmt::format("written    {}\n", file));
    json.push_back({{"factor", factor}, {"file", file}});
  }
  return json;
}

double cut_of(const Arguments& arguments) {
  if (arguments.cut == "none") return 0;
  if (arguments.cut == "auto") return shortest_playable_wavelength_mm(arguments.speed_mm_per_s, arguments.rate_hz);
  double value = 0;
  const char* end = arguments.cut.data() + arguments.cut.size();
  const auto parsed = std::from_chars(arguments.cut.data(), end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end || !(value > 0) || !std::isfinite(value))
    throw UsageError("--cut " + arguments.cut + " is not auto, none or a positive number of millimetres");
  return value;
}

Json run(Arguments& arguments, VerbContext& context) {
  HeightOptions& options = arguments.options;
  options.method = height_method(arguments.method);
  if (arguments.light != "auto") options.light = parse_vector("--light", arguments.light);
  if (arguments.periodic != "auto") options.periodic = arguments.periodic == "yes";
  options.roughness = height_roughness(arguments.roughness);
  options.shortest_wavelength_mm = cut_of(arguments);
  options.seed = context.seed;
  options.progress = context.progress;
  const HeightResult result = height_from_image(read_grey_image(arguments.image), options);
  write_height_file(arguments.output, result.map);
  if (!arguments.normal.empty()) write_color_image(arguments.normal, normal_map(result.map));
  print(context.console, arguments, result);
  Json json = to_json(result);
  json["alternative"] =
      arguments.alternative ? write_alternative(arguments.output, result, context.console) : Json(nullptr);
  if (arguments.variants) json["variants"] = write_variants(arguments.output, result.map, context.console);
  if (!arguments.pictures.empty()) json["pictures"] = write_pictures(arguments.pictures, result.map, context.console);
  return json;
}

}  // namespace

void add_height(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb =
      add_verb(program,
               {"height", "Turns a picture of a surface into a height map in millimetres",
                "papilla synthesize grain --kind spheres8 -o grain.png && papilla height grain.png -o height.png"},
               [arguments](VerbContext& context) { return run(*arguments, context); });
  verb->add_option("image", arguments->image, "Picture")->required()->type_name("IMAGE");
  verb->add_option("-o,--output", arguments->output, "Height map: 16-bit .png, or .exr or .tif in millimetres")
      ->required()
      ->type_name("FILE");
  verb->add_option("--normal", arguments->normal, "Write the glTF normal map of the relief too")->type_name("FILE");
  verb->add_option("--pitch", arguments->options.pitch_mm, "Millimetres per pixel; default from the file's resolution")
      ->type_name("MM")
      ->check(CLI::PositiveNumber);
  verb->add_option("--depth", arguments->options.depth_mm, "Peak to valley")
      ->type_name("MM")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--method", arguments->method, "How grey becomes height")
      ->check(CLI::IsMember({"auto", "variational", "pentland", "tsai-shah", "intensity"}))
      ->capture_default_str();
  verb->add_option("--light", arguments->light, "Direction to the light: x right, y down, z to the viewer")
      ->type_name("auto|X,Y,Z")
      ->capture_default_str();
  verb->add_option("--periodic", arguments->periodic,
                   "Whether the height shall tile; auto looks whether the picture does")
      ->check(CLI::IsMember({"auto", "yes", "no"}))
      ->capture_default_str();
  verb->add_option("--roughness", arguments->roughness,
                   "With a lattice: relief and roughness as one (whole), or the relief of the symmetric part with no "
                   "roughness, the residual, or a synthesized surface like it")
      ->check(CLI::IsMember({"whole", "none", "residual", "synthesized"}))
      ->capture_default_str();
  verb->add_option("--cut", arguments->cut, "Leave out shorter waves; auto: two ticks of the device at --speed")
      ->type_name("auto|none|MM")
      ->capture_default_str();
  verb->add_option("--rate", arguments->rate_hz, "Of the device, for --cut auto")
      ->type_name("HZ")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--speed", arguments->speed_mm_per_s, "Of the hand, for --cut auto")
      ->type_name("MM/S")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_flag("--tile", arguments->options.tile,
                 "One tile of the lattice, exactly periodic whatever its angle; its roughness is synthesized");
  verb->add_flag("--alternative", arguments->alternative,
                 "Write the relief that the opposite light would make of the same picture too");
  verb->add_flag("--variants", arguments->variants, "Write the relief twice and four times as deep too");
  verb->add_option("--pictures", arguments->pictures,
                   "Write the lit relief, its opposite and the cross-section into DIR")
      ->type_name("DIR");
}

}  // namespace papilla::app
