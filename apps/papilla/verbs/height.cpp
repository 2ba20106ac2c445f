// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/height_from_image.hpp"

#include <fmt/core.h>

#include <memory>

#include "height_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/normal_map.hpp"
#include "vector_option.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Arguments {
  std::string image, output, normal;
  std::string method = "auto", light = "auto", periodic = "auto";
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
  if (!result.trace.empty())
    console.print(fmt::format("shading    residual {:.4f} after {} steps, {:.2f} s, {}\n", result.trace.back().error,
                              result.trace.size(), result.trace.back().seconds, to_string(result.stop)));
  console.print(fmt::format("written    {}\n", arguments.output));
}

Json run(Arguments& arguments, VerbContext& context) {
  HeightOptions& options = arguments.options;
  options.method = height_method(arguments.method);
  if (arguments.light != "auto") options.light = parse_vector("--light", arguments.light);
  if (arguments.periodic != "auto") options.periodic = arguments.periodic == "yes";
  options.progress = context.progress;
  const HeightResult result = height_from_image(read_grey_image(arguments.image), options);
  write_height_file(arguments.output, result.map);
  if (!arguments.normal.empty()) write_color_image(arguments.normal, normal_map(result.map));
  print(context.console, arguments, result);
  return to_json(result);
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
      ->check(CLI::IsMember({"auto", "variational", "tsai-shah", "intensity"}))
      ->capture_default_str();
  verb->add_option("--light", arguments->light, "Direction to the light: x right, y down, z to the viewer")
      ->type_name("auto|X,Y,Z")
      ->capture_default_str();
  verb->add_option("--periodic", arguments->periodic,
                   "Whether the height shall tile; auto looks whether the picture does")
      ->check(CLI::IsMember({"auto", "yes", "no"}))
      ->capture_default_str();
}

}  // namespace papilla::app
