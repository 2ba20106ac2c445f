// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>
#include <vector>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/texture_json.hpp"
#include "options/texture_option.hpp"
#include "text/texture_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::vector<std::string> images;
  std::string output, lights, references;
  bool is_depth_given = false;
  HeightOption height;
};

Json run_several(const Options& options, VerbContext& context) {
  StereoFileOptions stereo{options.height.options(context.seed, context.progress), {}, {}, options.is_depth_given};
  if (!options.lights.empty()) stereo.lights = read_lights(options.lights, options.images.size());
  if (!options.references.empty()) stereo.references = read_references(options.references);
  const StereoFiles files =
      height_of_picture_files({options.images.begin(), options.images.end()}, options.output, stereo);
  context.console.print(stereo_text(options.output, files));
  return stereo_json(files);
}

/// Options of one picture say nothing of several, and the other way round.
void require_options_that_fit(const CLI::App& verb, std::size_t images) {
  const auto given = [&](const char* name) { return verb.get_option(name)->count() > 0; };
  for (const char* name : {"--lights", "--reference"})
    if (images == 1 && given(name)) throw UsageError(std::string(name) + " needs several photographs");
  for (const char* name : {"--method", "--light", "--periodic", "--roughness", "--cut", "--tile", "--by-class"})
    if (images > 1 && given(name)) throw UsageError(std::string(name) + " is for one picture");
}

Json run(const Options& options, VerbContext& context) {
  if (options.images.size() > 1) return run_several(options, context);
  const HeightFiles files = height_of_picture_file(options.images.front(), options.output,
                                                   options.height.options(context.seed, context.progress));
  context.console.print(height_text(options.images.front(), options.output, files));
  return height_json(files);
}

}  // namespace

void add_height(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"height", "Turns a picture of a surface into a height map in millimetres",
                "papilla synthesize grain --kind spheres8 -o grain.png && papilla height grain.png -o height.png"},
               [options, &program](VerbContext& context) {
                 const CLI::App& given = *program.get_subcommand("height");
                 require_options_that_fit(given, options->images.size());
                 options->is_depth_given = given.get_option("--depth")->count() > 0;
                 return run(*options, context);
               });
  reads(verb->add_option("image", options->images, "Picture; three or more of one place under different light"))
      ->required()
      ->type_name("IMAGE");
  writes(verb->add_option("-o,--output", options->output, "Height map: 16-bit .png, or .exr or .tif in millimetres"))
      ->required()
      ->type_name("FILE");
  reads(verb->add_option("--lights", options->lights, "Lights of several photographs, or a ball that shows them"))
      ->type_name("LIGHTS.json");
  reads(verb->add_option("--reference", options->references,
                         "Ruler, grid, step, profile or shadow in several photographs: pitch and depth"))
      ->type_name("REF.json");
  options->height.add_to(*verb);
}

}  // namespace papilla::app
