// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "json/texture_json.hpp"
#include "options/texture_option.hpp"
#include "papilla/io/image_file.hpp"
#include "text/texture_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string what, output, relief;
  SynthesisOption synthesis;
};

Json run(const Options& options, VerbContext& context) {
  const SynthesisOptions synthesis = options.synthesis.options(options.what, context.seed, context.progress);
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
                            {"synthesize", "Makes test grains and fractal surfaces",
                             "papilla synthesize grain --kind leather -o leather.png --relief leather-height.png"},
                            [options](VerbContext& context) { return run(*options, context); });
  verb->add_option("what", options->what, "grain or fractal")->required()->check(CLI::IsMember({"grain", "fractal"}));
  verb->add_option("-o,--output", options->output, "Picture: the lit grain, or the fractal surface as grey values")
      ->required()
      ->type_name("FILE");
  verb->add_option("--relief", options->relief, "True relief: 16-bit .png, or .exr or .tif in millimetres")
      ->type_name("FILE");
  options->synthesis.add_to(*verb);
}

}  // namespace papilla::app
