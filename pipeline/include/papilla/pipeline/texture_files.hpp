// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/procedural/shader.hpp"
#include "papilla/procedural/texture.hpp"

namespace papilla {

/// Options of write_texture_files().
struct TextureFileOptions {
  int width = 512, height = 512;
  std::vector<Channel> channels = {Channel::color, Channel::bump};
  int bits = 8;             ///< 8 or 16 (PNG), 32 (EXR); colours have 8.
  bool normalize = false;   ///< Stretch every channel but the colour to [0, 1].
  bool normal_map = false;  ///< Write the glTF normal map of the height too.
  bool preview = false;     ///< Write preview.png too: the texture in the light of its recipe.
  bool video = false;       ///< Write the series as series.gif too, in that light.
  double size_mm = 40;      ///< Width of the picture, for pitch, normal map, preview and video.
  double depth_mm = 0.3;    ///< Height of 1, for normal map, preview and video.
  double time = 0;          ///< 0 new to 1 worn.
  int steps = 1;            ///< Above 1: a series of pictures from time 0 to 1, numbered from .0000 on.
  bool seamless = false;    ///< As if the recipe said seamless=true.
  double mutation = 0;      ///< mutate_recipe() by this share first; 0: not at all.
  std::uint64_t seed = 1;   ///< Of the recipe and of its mutation.
  ProgressCallback progress = {};
};

/// A channel as it was written.
struct ChannelFile {
  Channel channel;
  std::string file;  ///< Its name in the folder.
  float low, high;
  double mean;
  std::optional<double> time;  ///< In a series.
};

/// What write_texture_files() returns.
struct TextureFiles {
  std::string recipe;  ///< As it was rendered: mutated when asked for.
  int width = 0, height = 0;
  std::vector<ChannelFile> channels;
  std::vector<std::string> normal_maps;      ///< Names in the folder.
  std::vector<std::string> previews;         ///< Names in the folder.
  std::string video;                         ///< Name in the folder; empty: none.
  std::optional<ProceduralTexture> texture;  ///< Compiled for the last picture.
  double seconds = 0;                        ///< To compile and render all pictures.
};

/// Renders a recipe and writes its channels into a folder, which is made when it is missing. Pictures that the recipe
/// names lie in the current folder or below it.
/// @throws InvalidInput as compile_texture() and render_texture(); IoError when writing fails.
TextureFiles write_texture_files(const std::string& recipe, const RecipeLibrary& library,
                                 const std::filesystem::path& folder, const TextureFileOptions& options = {});

/// Wang tiles of a recipe as they were written.
struct WangFiles {
  int side = 0;                       ///< Texels a side of a tile.
  std::vector<ChannelFile> channels;  ///< wang.NAME.png: 4 x 2 tiles each, see WangTileSet.
  std::string plane;                  ///< Colours of 8 x 8 tiles as wang_tile_at() lays them with seed 1.
  double seam_cost = 0;               ///< Of the set.
};

/// Renders a recipe, makes Wang tiles of it by its colour and height, and writes their channels. Steps, normal map,
/// preview and video are not looked at.
/// @param side  texels a side of a tile; 0: a quarter of the picture, which is options.width x options.height.
/// @throws InvalidInput as compile_texture(), render_texture() and make_wang_tiles(); IoError when writing fails.
WangFiles write_wang_files(const std::string& recipe, const RecipeLibrary& library, const std::filesystem::path& folder,
                           int side, const TextureFileOptions& options = {});

/// The recipe with these options as a shader. @throws InvalidInput as compile_texture() and shader_source().
std::string texture_shader(const std::string& recipe, const RecipeLibrary& library, ShaderLanguage language,
                           const TextureFileOptions& options = {});

}  // namespace papilla
