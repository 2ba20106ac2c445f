// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "file_options.hpp"
#include "json/texture_json.hpp"
#include "options/texture_option.hpp"
#include "text/texture_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string image, output;
  HeightOption height;
};

Json run(const Options& options, VerbContext& context) {
  const HeightFiles files =
      height_of_picture_file(options.image, options.output, options.height.options(context.seed, context.progress));
  context.console.print(height_text(options.image, options.output, files));
  return height_json(files);
}

}  // namespace

void add_height(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"height", "Turns a picture of a surface into a height map in millimetres",
                "papilla synthesize grain --kind spheres8 -o grain.png && papilla height grain.png -o height.png"},
               [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("image", options->image, "Picture"))->required()->type_name("IMAGE");
  writes(verb->add_option("-o,--output", options->output, "Height map: 16-bit .png, or .exr or .tif in millimetres"))
      ->required()
      ->type_name("FILE");
  options->height.add_to(*verb);
}

}  // namespace papilla::app
