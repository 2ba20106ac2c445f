// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "exit_code.hpp"
#include "height_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "vector_option.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Arguments {
  std::string what, output, relief;
  std::string kind = "spheres8", light;
  std::string method = "exact";
  double hurst = 0.5;
  bool tile = false;
  std::optional<int> size;
  double size_mm = GrainOptions{}.size_mm, height_mm = GrainOptions{}.height_mm;
};

struct Synthesized {
  std::string method;
  GreyImage picture;
  HeightMap relief;
};

Synthesized grain(const Arguments& arguments, std::uint64_t seed) {
  GrainOptions options;
  options.size_px = arguments.size.value_or(options.size_px);
  options.size_mm = arguments.size_mm;
  options.height_mm = arguments.height_mm;
  options.seed = seed;
  if (!arguments.light.empty()) options.light = parse_vector("--light", arguments.light);
  GrainResult result = synthesize_grain(grain_kind(arguments.kind), options);
  return {arguments.kind, std::move(result.picture), std::move(result.relief)};
}

Synthesized fractal(const Arguments& arguments, std::uint64_t seed) {
  const std::string method = arguments.tile ? "spectral" : arguments.method;
  const int size = arguments.size.value_or(method == "exact" ? 257 : 256);
  const Surface surface = method == "exact" ? brownian_surface_exact({size, arguments.hurst, seed})
                                            : spectral_surface({.size = size, .hurst = arguments.hurst, .seed = seed});
  Synthesized result{method, to_grey_image(surface), {}};
  const double pitch = arguments.size_mm / size;
  result.picture.pitch_mm = pitch;
  result.relief = {size, size, result.picture.pixels, pitch, pitch, surface.periodic};
  for (float& height : result.relief.mm) height *= static_cast<float>(arguments.height_mm);
  return result;
}

Json run(const Arguments& arguments, VerbContext& context) {
  if (arguments.tile && arguments.method == "exact" && arguments.what == "fractal")
    context.console.print("--tile takes the spectral method: exact surfaces do not tile\n");
  const Synthesized result =
      arguments.what == "grain" ? grain(arguments, context.seed) : fractal(arguments, context.seed);
  write_grey_image(arguments.output, result.picture, 16);
  if (!arguments.relief.empty()) write_height_file(arguments.relief, result.relief);
  const auto [low, high] = std::minmax_element(result.relief.mm.begin(), result.relief.mm.end());
  context.console.print(
      fmt::format("{} {}: {} x {} pixels of {:.4f} mm, heights {:.3f} to {:.3f} mm, {}\nwritten {}{}{}\n",
                  arguments.what, result.method, result.relief.width, result.relief.height, result.relief.pitch_mm_x,
                  *low, *high, result.relief.periodic ? "tiles" : "does not tile", arguments.output,
                  arguments.relief.empty() ? "" : " and ", arguments.relief));
  Json json{{"what", arguments.what}, {"method", result.method}, {"size", {result.relief.width, result.relief.height}}};
  json["pitch_mm"] = result.relief.pitch_mm_x;
  json["range"] = {*low, *high};
  json["periodic"] = result.relief.periodic;
  json["seed"] = context.seed;
  if (arguments.what == "fractal") json["hurst"] = arguments.hurst;
  return json;
}

}  // namespace

void add_synthesize(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = add_verb(program,
                            {"synthesize", "Makes test grains and fractal surfaces",
                             "papilla synthesize grain --kind leather -o leather.png --relief leather-height.png"},
                            [arguments](VerbContext& context) { return run(*arguments, context); });
  std::vector<std::string> kinds;
  for (const std::string_view name : grain_names()) kinds.emplace_back(name);
  verb->add_option("what", arguments->what, "grain or fractal")->required()->check(CLI::IsMember({"grain", "fractal"}));
  verb->add_option("-o,--output", arguments->output, "Picture: the lit grain, or the fractal surface as grey values")
      ->required()
      ->type_name("FILE");
  verb->add_option("--relief", arguments->relief, "True relief: 16-bit .png, or .exr or .tif in millimetres")
      ->type_name("FILE");
  verb->add_option("--size", arguments->size, "Pixels a side; 512 for grain, 257 for exact, 256 for spectral")
      ->type_name("N");
  verb->add_option("--size-mm", arguments->size_mm, "Side of the tile")
      ->type_name("MM")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--height-mm", arguments->height_mm, "Peak to valley")
      ->type_name("MM")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--kind", arguments->kind, "Grain")->check(CLI::IsMember(kinds))->capture_default_str();
  verb->add_option("--light", arguments->light, "Grain: direction to the light, x right, y down, z to the viewer")
      ->type_name("X,Y,Z");
  verb->add_option("--method", arguments->method,
                   "Fractal: exact (fractional Brownian surface), spectral (tiles, smoother)")
      ->check(CLI::IsMember({"exact", "spectral"}))
      ->capture_default_str();
  verb->add_option("--hurst", arguments->hurst, "Fractal: H in (0, 1); the dimension is 3 - H")->capture_default_str();
  verb->add_flag("--tile", arguments->tile, "Fractal: the result shall tile");
}

}  // namespace papilla::app
