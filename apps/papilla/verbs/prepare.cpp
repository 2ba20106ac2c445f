// SPDX-License-Identifier: GPL-3.0-or-later
#include "option_checks.hpp"
#include "papilla/pipeline/prepare_file.hpp"

#include <memory>

#include "file_options.hpp"
#include "json/texture_json.hpp"
#include "text/texture_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string image, output;
  std::string borders = "auto";
  bool keep_gradients = false, keep_contrast = false;
  PrepareFileOptions prepare;
};

Json run(Options& options, VerbContext& context) {
  PrepareOptions& prepare = options.prepare.prepare;
  prepare.borders = border_matching(options.borders);
  prepare.flatten = !options.keep_gradients;
  prepare.contrast = !options.keep_contrast;
  prepare.progress = context.progress;
  const PreparedPicture prepared = prepare_picture_file(options.image, options.output, options.prepare);
  context.console.print(prepared_text(options.output, prepared));
  return prepared_json(options.image, prepared);
}

}  // namespace

void add_prepare(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"prepare", "Makes a scanned or photographed surface even, clear and tileable",
                "papilla synthesize fractal --hurst 0.3 -o rough.png && papilla prepare rough.png -o even.png"},
               [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("image", options->image, "Picture"))->required()->type_name("IMAGE");
  writes(verb->add_option("-o,--output", options->output, "Prepared picture, 16 bit"))->required()->type_name("FILE");
  verb->add_option("--borders", options->borders, "How borders are matched")
      ->transform(one_of({"auto", "none", "cut", "mirror"}))
      ->capture_default_str();
  verb->add_option("--plasticity", options->prepare.prepare.plasticity, "Raise fine detail by this factor")
      ->check(in_range(0.0, 4.0))
      ->capture_default_str();
  verb->add_option("--flatten", options->prepare.prepare.flatten_px,
                   "Standard deviation of the blur that finds gradients; default from the picture and its lattice")
      ->type_name("PX")
      ->check(positive());
  verb->add_flag("--straighten", options->prepare.prepare.straighten,
                 "Straighten a lattice that bends, as cloth and knitwear do");
  verb->add_flag("--keep-gradients", options->keep_gradients, "Leave gradients of brightness and contrast");
  verb->add_flag("--keep-contrast", options->keep_contrast, "Leave the range of the grey values");
  verb->add_option("--size", options->prepare.width_px, "Scale the result to N pixels across")
      ->type_name("N")
      ->check(in_range(16, 16384));
  verb->add_option("--pitch", options->prepare.pitch_mm, "Millimetres per pixel; default from the file's resolution")
      ->type_name("MM")
      ->check(positive());
}

}  // namespace papilla::app
