// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/texture_json.hpp"
#include "option_checks.hpp"
#include "options/vector_option.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/photograph_file.hpp"
#include "text/texture_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string what, relief_file, output, relief, kind = "spheres8", light, method = "exact", like;
  SynthesisOptions synthesis;
  PhotographFileOptions photo;
  bool no_shadows = false;
};

Json run_photo(const Options& options, VerbContext& context) {
  if (options.relief_file.empty()) throw UsageError("synthesize photo needs a RELIEF: a height map");
  PhotographFileOptions photo = options.photo;
  if (!options.light.empty()) photo.photograph.light = parse_vector("--light", options.light);
  photo.photograph.cast_shadows = !options.no_shadows;
  photo.photograph.seed = context.seed;
  photo.height_mm = options.synthesis.height_mm;
  const PhotographFile result = photograph_of_relief_file(options.relief_file, options.output, photo);
  context.console.print(photograph_text(options.relief_file, options.output, result));
  return photograph_json(options.relief_file, result, photo);
}

Json run(const Options& options, VerbContext& context) {
  if (options.what == "photo") return run_photo(options, context);
  if (!options.relief_file.empty()) throw UsageError("synthesize " + options.what + " takes no RELIEF");
  SynthesisOptions synthesis = options.synthesis;
  if (options.what == "grain") synthesis.grain = grain_kind(options.kind);
  if (synthesis.grain && !options.light.empty()) synthesis.light = parse_vector("--light", options.light);
  synthesis.method = fractal_synthesis(options.method);
  synthesis.like = options.like;
  synthesis.seed = context.seed;
  synthesis.progress = context.progress;
  const Synthesis result = synthesize_texture(synthesis);
  write_grey_image(options.output, result.picture, 16);
  if (!options.relief.empty()) write_height_file(options.relief, result.relief);
  context.console.print(synthesis_text(options.what, options.output, options.relief, result, synthesis));
  return synthesis_json(options.what, result, synthesis);
}

}  // namespace

void add_synthesize(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(program,
                            {"synthesize", "Makes test grains, fractal surfaces and photographs of reliefs",
                             "papilla synthesize grain --kind leather -o leather.png --relief leather-height.png"},
                            [options](VerbContext& context) { return run(*options, context); });
  std::vector<std::string> kinds;
  for (const std::string_view name : grain_names()) kinds.emplace_back(name);
  verb->add_option("what", options->what, "grain, fractal or photo")
      ->required()
      ->transform(one_of({"grain", "fractal", "photo"}));
  reads(verb->add_option("relief_file", options->relief_file,
                         "Photo: height map of the surface, a picture or millimetres"))
      ->type_name("RELIEF");
  writes(verb->add_option(
             "-o,--output", options->output,
             "Picture: the lit grain, the fractal surface as grey values, or the photograph (.exr: linear floats)"))
      ->required()
      ->type_name("FILE");
  writes(verb->add_option("--relief", options->relief, "True relief: 16-bit .png, or .exr or .tif in millimetres"))
      ->type_name("FILE");
  verb->add_option("--size", options->synthesis.size_px,
                   "Pixels a side; 512 for grain, 256 for spectral and --like, 1025 for a graph, else 257")
      ->type_name("N");
  verb->add_option("--size-mm", options->synthesis.size_mm, "Side of the tile")
      ->type_name("MM")
      ->check(positive())
      ->capture_default_str();
  verb->add_option("--height-mm", options->synthesis.height_mm, "Peak to valley")
      ->type_name("MM")
      ->check(positive())
      ->capture_default_str();
  verb->add_option("--kind", options->kind, "Grain")->transform(one_of(kinds))->capture_default_str();
  verb->add_option("--light", options->light, "Grain, photo: direction to the light, x right, y down, z to the viewer")
      ->type_name("X,Y,Z");
  PhotographOptions& photo = options->photo.photograph;
  verb->add_option("--pitch", options->photo.pitch_mm, "Photo: millimetres per pixel; default from the file, or 0.1")
      ->type_name("MM")
      ->check(positive());
  verb->add_option("--ambient", photo.ambient, "Photo: share of the light that comes from everywhere")
      ->capture_default_str();
  verb->add_flag("--no-cast-shadows", options->no_shadows, "Photo: only what faces away from the light is dark");
  verb->add_option("--specular", photo.specular.strength, "Photo: strength of the highlights, 0 to 1")
      ->capture_default_str();
  verb->add_option("--shininess", photo.specular.shininess, "Photo: exponent of the highlights")->capture_default_str();
  verb->add_option("--albedo-noise", photo.albedo_noise, "Photo: rms of the albedo's spots, of 1")
      ->capture_default_str();
  verb->add_option("--spot-px", photo.albedo_spot_px, "Photo: radius of the spots")->capture_default_str();
  verb->add_option("--surface-seed", photo.surface_seed,
                   "Photo: seed of the spots, the same for all photographs of one surface; --seed is that of noise and "
                   "uneven light")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--valley-darkening", photo.valley_darkening, "Photo: share by which the lowest point is darker")
      ->capture_default_str();
  verb->add_option("--vignette", photo.vignette, "Photo: loss of light at the corners, of 1")->capture_default_str();
  verb->add_option("--uneven-light", photo.uneven_light,
                   "Photo: linear change of the light from border to border, +- this share")
      ->capture_default_str();
  verb->add_option("--blur-px", photo.blur_px, "Photo: standard deviation of the point spread")->capture_default_str();
  verb->add_option("--noise", photo.noise, "Photo: standard deviation of the sensor's noise, of white")
      ->capture_default_str();
  verb->add_option("--jpeg-quality", options->photo.jpeg_quality, "Photo: of .jpg")
      ->check(in_range(1, 100))
      ->capture_default_str();
  verb->add_option(
          "--method", options->method,
          "Fractal: exact (fractional Brownian surface), spectral (tiles, smoother), brownian-surface (midpoint "
          "displacement), cho (its three-step variant), brownian-graph (one row)")
      ->transform(one_of({"exact", "spectral", "brownian-surface", "cho", "brownian-graph"}))
      ->capture_default_str();
  CLI::Option* hurst =
      verb->add_option("--hurst", options->synthesis.hurst, "Fractal: H in (0, 1); the dimension is 3 - H")
          ->capture_default_str();
  verb->add_option("--dimension", options->synthesis.dimension, "Fractal: dimension in place of H, of a graph 2 - H")
      ->type_name("D")
      ->excludes(hurst);
  reads(verb->add_option("--like", options->like, "Fractal: with the roughness and direction of this picture"))
      ->type_name("IMAGE");
  verb->add_flag("--tile", options->synthesis.tile, "Fractal: the result shall tile");
}

}  // namespace papilla::app
