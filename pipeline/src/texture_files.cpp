// SPDX-License-Identifier: MIT
#include "papilla/pipeline/texture_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/animation_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/procedural/preview.hpp"
#include "papilla/texture/normal_map.hpp"
#include "papilla/texture/wang_tiles.hpp"

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

ChannelFile write_channel(const RenderedTexture& texture, Channel channel, const std::string& prefix,
                          const std::string& suffix, const std::filesystem::path& folder,
                          const TextureFileOptions& options) {
  const std::vector<float>& values = texture.values[channel];
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  const std::string file = prefix + std::string(to_string(channel)) + suffix + (options.bits == 32 ? ".exr" : ".png");
  if (channel == Channel::color) {
    write_color_image(folder / file, to_color_image(values, texture.width, texture.height));
  } else {
    GreyImage image{texture.width, texture.height, Values<float>(values.begin(), values.end()),
                    options.size_mm / texture.width, options.bits};
    if (options.normalize && *high > *low) {
      const float base = *low, range = *high - *low;
      for (float& v : image.pixels) v = (v - base) / range;
    }
    write_grey_image(folder / file, image, options.bits);
  }
  return {channel, file, *low, *high, mean, {}};
}

CompileOptions compile_options(const TextureFileOptions& options) {
  CompileOptions compile = recipe_options(".");
  compile.time = options.time, compile.seamless = options.seamless;
  compile.target_px = std::min(options.width, options.height);
  compile.seed = static_cast<std::uint32_t>(options.seed - 1);
  return compile;
}

std::string mutated(const std::string& recipe, const RecipeLibrary& library, const TextureFileOptions& options) {
  return options.mutation > 0 ? mutate_recipe(recipe, library, static_cast<unsigned>(options.seed), options.mutation)
                              : recipe;
}

/// The planes of a picture that are moved together, those that cuts look at first: colour and height.
struct WangPlanes {
  std::vector<std::vector<float>> own;  ///< Red, green, blue.
  std::vector<std::span<const float>> all;
  std::vector<Channel> grey;  ///< Of the planes behind the colour, height first.
};

WangPlanes wang_planes(const RenderedTexture& rendered, const std::vector<Channel>& channels) {
  WangPlanes planes;
  planes.own.resize(3);
  const std::vector<float>& colour = rendered.values[Channel::color];
  for (std::size_t i = 0; i < colour.size(); ++i) planes.own[i % 3].push_back(colour[i]);
  planes.all.assign(planes.own.begin(), planes.own.end());
  planes.grey = {Channel::bump};
  for (const Channel channel : channels)
    if (channel != Channel::color && channel != Channel::bump) planes.grey.push_back(channel);
  for (const Channel channel : planes.grey) planes.all.emplace_back(rendered.values[channel]);
  return planes;
}

/// Three planes as a colour a texel.
std::vector<float> interleaved(const std::array<std::vector<float>, 3>& planes) {
  std::vector<float> colour;
  colour.reserve(3 * planes[0].size());
  for (std::size_t i = 0; i < planes[0].size(); ++i)
    for (const auto& plane : planes) colour.push_back(plane[i]);
  return colour;
}

std::string write_normal_map(const RenderedTexture& rendered, const std::string& suffix,
                             const std::filesystem::path& folder, const TextureFileOptions& options) {
  const double pitch = options.size_mm / rendered.width;
  const std::vector<float>& bump = rendered.values[Channel::bump];
  HeightMap map{rendered.width, rendered.height, Values<float>(bump.begin(), bump.end()),
                pitch,          pitch,           options.seamless};
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
  files.recipe = mutated(recipe, library, options);
  files.width = options.width, files.height = options.height;
  const bool is_series = options.steps > 1;
  std::vector<ColorImage> frames;
  for (int step = 0; step < options.steps; ++step) {
    CompileOptions compile = compile_options(options);
    if (is_series) compile.time = static_cast<double>(step) / (options.steps - 1);
    const Stopwatch clock;
    files.texture = compile_texture(files.recipe, library, compile);
    const RenderedTexture rendered =
        render_texture(*files.texture, {options.width, options.height, rendered_channels(options), {}});
    files.seconds += clock.seconds();
    const std::string suffix = is_series ? fmt::format(".{:04}", step) : "";
    for (const Channel channel : options.channels) {
      files.channels.push_back(write_channel(rendered, channel, "", suffix, folder, options));
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

WangFiles write_wang_files(const std::string& recipe, const RecipeLibrary& library, const std::filesystem::path& folder,
                           int side, const TextureFileOptions& options) {
  constexpr int k_laid = 8;
  make_folder(folder);
  const ProceduralTexture texture =
      compile_texture(mutated(recipe, library, options), library, compile_options(options));
  RenderOptions render;
  render.width = options.width, render.height = options.height, render.progress = options.progress;
  render.channels = rendered_channels(options) | bit(Channel::color) | bit(Channel::bump);
  const RenderedTexture rendered = render_texture(texture, render);
  const WangPlanes planes = wang_planes(rendered, options.channels);
  WangOptions wang;
  wang.side = side > 0 ? side : std::min(options.width, options.height) / 8 * 2;
  wang.seed = static_cast<std::uint32_t>(options.seed);
  const WangTileSet set = make_wang_tiles(planes.all, 4, rendered.width, rendered.height, wang);
  WangFiles files;
  files.side = set.side, files.seam_cost = set.seam_cost;
  RenderedTexture sheet{4 * set.side, 2 * set.side, {}};
  TextureFileOptions sheet_options = options;
  sheet_options.size_mm = options.size_mm / rendered.width * sheet.width;
  sheet.values.channels[static_cast<std::size_t>(Channel::color)] =
      interleaved({set.planes[0], set.planes[1], set.planes[2]});
  for (std::size_t k = 0; k < planes.grey.size(); ++k)
    sheet.values.channels[static_cast<std::size_t>(planes.grey[k])] = set.planes[3 + k];
  for (const Channel channel : options.channels)
    files.channels.push_back(write_channel(sheet, channel, "wang.", "", folder, sheet_options));
  files.plane = "wang.plane.png";
  const auto laid = [&](std::size_t plane) { return lay_wang_tiles(set, plane, k_laid, k_laid, 1); };
  write_color_image(folder / files.plane,
                    to_color_image(interleaved({laid(0), laid(1), laid(2)}), k_laid * set.side, k_laid * set.side));
  return files;
}

std::string texture_shader(const std::string& recipe, const RecipeLibrary& library, ShaderLanguage language,
                           const TextureFileOptions& options) {
  return shader_source(compile_texture(mutated(recipe, library, options), library, compile_options(options)),
                       {language, options.width, options.height});
}

}  // namespace papilla
