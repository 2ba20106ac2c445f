// SPDX-License-Identifier: MIT
#include "papilla/pipeline/texture_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/animation_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/procedural/preview.hpp"
#include "papilla/texture/normal_map.hpp"

namespace papilla {
namespace {

constexpr double k_video_rate_hz = 10;

constexpr unsigned bit(Channel channel) { return 1U << static_cast<unsigned>(channel); }

unsigned rendered_channels(const TextureFileOptions& options) {
  unsigned bits = 0;
  if (options.normal_map) bits |= bit(Channel::bump);
  if (options.video || options.preview) bits |= k_preview_channels;
  for (const Channel channel : options.channels) bits |= bit(channel);
  return bits;
}

ChannelFile write_channel(const RenderedTexture& texture, Channel channel, const std::string& suffix,
                          const std::filesystem::path& folder, const TextureFileOptions& options) {
  const std::vector<float>& values = texture.values[channel];
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  const std::string file = std::string(to_string(channel)) + suffix + (options.bits == 32 ? ".exr" : ".png");
  if (channel == Channel::color) {
    write_color_image(folder / file, to_color_image(values, texture.width, texture.height));
  } else {
    GreyImage image{texture.width, texture.height, values, options.size_mm / texture.width, options.bits};
    if (options.normalize && *high > *low) {
      const float base = *low, range = *high - *low;
      for (float& v : image.pixels) v = (v - base) / range;
    }
    write_grey_image(folder / file, image, options.bits);
  }
  return {channel, file, *low, *high, mean, {}};
}

std::string write_normal_map(const RenderedTexture& rendered, const std::string& suffix,
                             const std::filesystem::path& folder, const TextureFileOptions& options) {
  const double pitch = options.size_mm / rendered.width;
  HeightMap map{rendered.width, rendered.height, rendered.values[Channel::bump], pitch, pitch, options.seamless};
  for (float& h : map.mm) h *= static_cast<float>(options.depth_mm);
  std::string file = "normal" + suffix + ".png";
  write_color_image(folder / file, normal_map(map));
  return file;
}

}  // namespace

TextureFiles write_texture_files(const std::string& recipe, const RecipeLibrary& library,
                                 const std::filesystem::path& folder, const TextureFileOptions& options) {
  make_folder(folder);
  TextureFiles files;
  files.recipe = options.mutation > 0
                     ? mutate_recipe(recipe, library, static_cast<unsigned>(options.seed), options.mutation)
                     : recipe;
  files.width = options.width, files.height = options.height;
  const bool is_series = options.steps > 1;
  std::vector<ColorImage> frames;
  for (int step = 0; step < options.steps; ++step) {
    CompileOptions compile = recipe_options(".");
    compile.time = is_series ? static_cast<double>(step) / (options.steps - 1) : options.time;
    compile.seamless = options.seamless;
    compile.target_px = std::min(options.width, options.height);
    compile.seed = static_cast<std::uint32_t>(options.seed - 1);
    const Stopwatch clock;
    files.texture = compile_texture(files.recipe, library, compile);
    const RenderedTexture rendered =
        render_texture(*files.texture, {options.width, options.height, rendered_channels(options), {}});
    files.seconds += clock.seconds();
    const std::string suffix = is_series ? fmt::format(".{:04}", step) : "";
    for (const Channel channel : options.channels) {
      files.channels.push_back(write_channel(rendered, channel, suffix, folder, options));
      if (is_series) files.channels.back().time = compile.time;
    }
    if (options.normal_map) files.normal_maps.push_back(write_normal_map(rendered, suffix, folder, options));
    if (options.video || options.preview) {
      const double relief = options.depth_mm / (options.size_mm / rendered.width);
      ColorImage lit = to_color_image(light_texture(*files.texture, rendered, relief), rendered.width, rendered.height);
      if (options.preview) {
        files.previews.push_back("preview" + suffix + ".png");
        write_color_image(folder / files.previews.back(), lit);
      }
      if (options.video) frames.push_back(std::move(lit));
    }
    report_progress(options.progress, "texture", (step + 1.0) / options.steps);
  }
  if (options.video) {
    files.video = "series.gif";
    write_animation(folder / files.video, frames, k_video_rate_hz);
  }
  return files;
}

}  // namespace papilla
