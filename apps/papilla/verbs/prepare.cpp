// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/prepare.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "papilla/io/image_file.hpp"
#include "papilla/texture/resample.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Arguments {
  std::string image, output;
  std::string borders = "auto";
  PrepareOptions options;
  bool keep_gradients = false, keep_contrast = false;
  std::optional<int> size;
  double pitch_mm = 0;
};

Json to_json(const PictureNumbers& n) {
  return {{"size", {n.width, n.height}},
          {"mean", n.mean},
          {"contrast", n.contrast},
          {"gradient", n.gradient},
          {"contrast_ratio", n.contrast_ratio},
          {"knots", n.knots},
          {"seam_x", n.tiling.seam_x},
          {"seam_y", n.tiling.seam_y},
          {"tiles", n.tiling.tiles}};
}

void print(const Console& console, const char* when, const PictureNumbers& n) {
  console.print(fmt::format(
      "{:<10} {} x {}, contrast {:.3f}, gradient {:.2f}, contrast ratio {:.2f}, knots {}, seams {:.2f} / {:.2f}, {}\n",
      when, n.width, n.height, n.contrast, n.gradient, n.contrast_ratio, n.knots, n.tiling.seam_x, n.tiling.seam_y,
      n.tiling.tiles ? "tiles" : "does not tile"));
}

/// Scaled to `width` pixels across, in proportion.
GreyImage scaled(const GreyImage& image, int width, bool periodic) {
  const int height =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(width) * image.height / image.width)));
  HeightMap map{image.width, image.height, image.pixels, 1, 1, periodic};
  map = resample(map, width, height);
  GreyImage result{width, height, std::move(map.mm), image.pitch_mm * image.width / width, 32};
  for (float& grey : result.pixels) grey = std::clamp(grey, 0.0F, 1.0F);
  return result;
}

Json run(Arguments& arguments, VerbContext& context) {
  GreyImage image = read_grey_image(arguments.image);
  if (arguments.pitch_mm > 0) image.pitch_mm = arguments.pitch_mm;
  arguments.options.borders = border_matching(arguments.borders);
  arguments.options.flatten = !arguments.keep_gradients;
  arguments.options.contrast = !arguments.keep_contrast;
  arguments.options.progress = context.progress;
  PreparedPicture prepared = prepare_picture(image, arguments.options);
  if (arguments.size) {
    prepared.image = scaled(prepared.image, *arguments.size, prepared.after.tiling.tiles);
    prepared.after = measure_picture(prepared.image);
    prepared.steps.push_back({"scale", true, "asked for"});
  }
  write_grey_image(arguments.output, prepared.image, 16);
  const Console& console = context.console;
  Json json{{"image", arguments.image}, {"before", to_json(prepared.before)}, {"after", to_json(prepared.after)}};
  json["pitch_mm"] = prepared.image.pitch_mm > 0 ? Json(prepared.image.pitch_mm) : Json(nullptr);
  json["steps"] = Json::array();
  print(console, "before", prepared.before);
  for (const PlanStep& step : prepared.steps) {
    json["steps"].push_back({{"step", step.step}, {"run", step.run}, {"reason", step.reason}});
    console.print(fmt::format("{:<10} {:<16} {}\n", step.run ? "run" : "skip", step.step, step.reason));
  }
  print(console, "after", prepared.after);
  json["warnings"] = prepared.warnings;
  for (const std::string& warning : prepared.warnings) console.print(fmt::format("warning    {}\n", warning));
  console.print(fmt::format("written    {}\n", arguments.output));
  return json;
}

}  // namespace

void add_prepare(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb =
      add_verb(program,
               {"prepare", "Makes a scanned or photographed surface even, clear and tileable",
                "papilla synthesize fractal --hurst 0.3 -o rough.png && papilla prepare rough.png -o even.png"},
               [arguments](VerbContext& context) { return run(*arguments, context); });
  verb->add_option("image", arguments->image, "Picture")->required()->type_name("IMAGE");
  verb->add_option("-o,--output", arguments->output, "Prepared picture, 16 bit")->required()->type_name("FILE");
  verb->add_option("--borders", arguments->borders, "How borders are matched")
      ->check(CLI::IsMember({"auto", "none", "cut", "mirror"}))
      ->capture_default_str();
  verb->add_option("--plasticity", arguments->options.plasticity, "Raise fine detail by this factor")
      ->check(CLI::Range(0.0, 4.0))
      ->capture_default_str();
  verb->add_option("--flatten", arguments->options.flatten_px,
                   "Standard deviation of the blur that finds gradients; default from the picture and its lattice")
      ->type_name("PX")
      ->check(CLI::PositiveNumber);
  verb->add_flag("--keep-gradients", arguments->keep_gradients, "Leave gradients of brightness and contrast");
  verb->add_flag("--keep-contrast", arguments->keep_contrast, "Leave the range of the grey values");
  verb->add_option("--size", arguments->size, "Scale the result to N pixels across")
      ->type_name("N")
      ->check(CLI::Range(16, 16384));
  verb->add_option("--pitch", arguments->pitch_mm, "Millimetres per pixel; default from the file's resolution")
      ->type_name("MM")
      ->check(CLI::PositiveNumber);
}

}  // namespace papilla::app
