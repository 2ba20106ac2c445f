// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "exit_code.hpp"
#include "papilla/pipeline/height_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/midpoint_surface.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "papilla/texture/surface_like.hpp"
#include "options/vector_option.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Arguments {
  std::string what, output, relief;
  std::string kind = "spheres8", light;
  std::string method = "exact";
  std::string like;
  double hurst = 0.5;
  std::optional<double> dimension;
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

/// Halvings of the side that give at least `size` samples, as midpoint displacement needs them.
int levels_for(int size) {
  int levels = 1;
  while ((1 << levels) + 1 < size && levels < 13) ++levels;
  return levels;
}

Surface fractal_surface(const Arguments& arguments, const std::string& method, int size, const VerbContext& context) {
  const std::uint64_t seed = context.seed;
  if (method == "exact") return brownian_surface_exact({size, arguments.hurst, seed, context.progress});
  if (method == "spectral")
    return spectral_surface({.size = size, .hurst = arguments.hurst, .seed = seed, .progress = context.progress});
  return midpoint_surface({.levels = levels_for(size),
                           .hurst = arguments.hurst,
                           .periodic = arguments.tile,
                           .rule = method == "cho" ? MidpointRule::cho : MidpointRule::corrected,
                           .seed = seed,
                           .progress = context.progress});
}

/// The surface as picture and as relief of the size and height asked for.
Synthesized scaled(const Arguments& arguments, std::string method, const Surface& surface) {
  Synthesized result{std::move(method), to_grey_image(surface), {}};
  const double pitch = arguments.size_mm / surface.size;
  result.picture.pitch_mm = pitch;
  result.relief = {surface.size, surface.size, result.picture.pixels, pitch, pitch, surface.periodic};
  for (float& height : result.relief.mm) height *= static_cast<float>(arguments.height_mm);
  return result;
}

Synthesized fractal(const Arguments& arguments, const VerbContext& context) {
  const std::string method = arguments.tile && arguments.method == "exact" ? "spectral" : arguments.method;
  const int size = arguments.size.value_or(method == "spectral" ? 256 : 257);
  return scaled(arguments, method, fractal_surface(arguments, method, size, context));
}

/// The graph as a picture of one row and as a relief that is the same in every row.
Synthesized graph(const Arguments& arguments, std::uint64_t seed) {
  const std::vector<double> heights =
      brownian_graph({.levels = levels_for(arguments.size.value_or(1025)), .hurst = arguments.hurst, .seed = seed});
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const int count = static_cast<int>(heights.size());
  const double pitch = arguments.size_mm / count, range = *high - *low;
  Synthesized result{"brownian-graph", {count, 1, {}, pitch, 32}, {count, 1, {}, pitch, pitch, false}};
  for (const double height : heights) {
    const double grey = range > 0 ? (height - *low) / range : 0;
    result.picture.pixels.push_back(static_cast<float>(grey));
    result.relief.mm.push_back(static_cast<float>(arguments.height_mm * grey));
  }
  return result;
}

Json signature_json(const FshotSignature& s) {
  return {{"sta", s.sta}, {"str", s.str}, {"fs_h", s.fs_h}, {"fs_v", s.fs_v}, {"angle_deg", s.angle_deg}};
}

Synthesized like(const Arguments& arguments, const VerbContext& context, Json& json) {
  const GreyImage image = read_grey_image(arguments.like);
  const SurfaceLike result =
      surface_like(image, {.size = arguments.size.value_or(256), .seed = context.seed, .progress = context.progress});
  json["like"] = {{"image", arguments.like},
                  {"target", signature_json(result.target)},
                  {"achieved", signature_json(result.achieved)},
                  {"hurst", result.hurst},
                  {"hurst_across", result.hurst_across}};
  context.console.print(fmt::format("like       {}: Sta {:.3f} (wanted {:.3f}), Str {:.3f} (wanted {:.3f})\n",
                                    arguments.like, result.achieved.sta, result.target.sta, result.achieved.str,
                                    result.target.str));
  return scaled(arguments, "like", result.surface);
}

Synthesized made(const Arguments& arguments, const VerbContext& context, Json& json) {
  if (!arguments.like.empty()) return like(arguments, context, json);
  if (arguments.what == "grain") return grain(arguments, context.seed);
  return arguments.method == "brownian-graph" ? graph(arguments, context.seed) : fractal(arguments, context);
}

Json run(Arguments& arguments, VerbContext& context) {
  if (arguments.dimension) arguments.hurst = (arguments.method == "brownian-graph" ? 2 : 3) - *arguments.dimension;
  if (arguments.tile && arguments.method == "exact" && arguments.what == "fractal")
    context.console.print("--tile takes the spectral method: exact surfaces do not tile\n");
  Json extra = Json::object();
  const Synthesized result = made(arguments, context, extra);
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
  if (arguments.what == "fractal" && arguments.like.empty()) json["hurst"] = arguments.hurst;
  json.update(extra);
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
  verb->add_option("--size", arguments->size,
                   "Pixels a side; 512 for grain, 256 for spectral and --like, 1025 for a graph, else 257")
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
  verb->add_option(
          "--method", arguments->method,
          "Fractal: exact (fractional Brownian surface), spectral (tiles, smoother), brownian-surface (midpoint "
          "displacement), cho (its three-step variant), brownian-graph (one row)")
      ->check(CLI::IsMember({"exact", "spectral", "brownian-surface", "cho", "brownian-graph"}))
      ->capture_default_str();
  CLI::Option* hurst = verb->add_option("--hurst", arguments->hurst, "Fractal: H in (0, 1); the dimension is 3 - H")
                           ->capture_default_str();
  verb->add_option("--dimension", arguments->dimension, "Fractal: dimension in place of H, of a graph 2 - H")
      ->type_name("D")
      ->excludes(hurst);
  verb->add_option("--like", arguments->like, "Fractal: with the roughness and direction of this picture")
      ->type_name("IMAGE");
  verb->add_flag("--tile", arguments->tile, "Fractal: the result shall tile");
}

}  // namespace papilla::app
