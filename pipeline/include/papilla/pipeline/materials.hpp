// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/haptic/material_tag.hpp"
#include "papilla/pipeline/object_texture_rules.hpp"
#include "papilla/pipeline/stereo_file.hpp"
#include "papilla/pipeline/surface_selector.hpp"
#include "papilla/pipeline/unwrap_method.hpp"
#include "papilla/texture/part_roughness.hpp"
#include "papilla/texture/picture_relief.hpp"

namespace papilla {

/// A texture "grain:leather" is the test grain of that name (grain.hpp), of which nothing has to be read.
inline constexpr std::string_view k_grain_prefix = "grain:";

/// How a material's picture becomes relief: the options of `papilla height`, and what a material has beside them.
struct HeightRule {
  PictureReliefOptions relief;  ///< Its pitch and depth, `seen` and progress are the grain's.
  /// Three or more photographs of one place under different light, whose relief it is; empty: that of the texture.
  std::vector<std::filesystem::path> images;
  StereoLights lights;                      ///< Of the images.
  std::vector<HeightReference> references;  ///< In the images.
  double pitch_mm = 0;                      ///< Of a picture without a size; 0: from the file's resolution.
  std::optional<double> depth_mm;           ///< Peak to valley; without it 1 % of the grain's shorter side.
  bool opposite = false;                    ///< The relief that the opposite light would make of the picture.
  double scale = 1;                         ///< Multiplies the heights; 1, 2 and 4 are the tested variants.
  std::optional<double> max_slope;  ///< Of the relief; without it default_max_slope() of the material's friction.
};

/// Where a constant of a material is larger and smaller: a picture or a recipe, read as grey, over what `texture`
/// shows.
struct MapRule {
  std::filesystem::path picture;  ///< As MaterialRule::texture.
  std::string recipe;             ///< What the file has, in case it is a recipe or a grain.
  double range[2] = {0.5, 1.5};   ///< Black and white, in multiples of the constant.
};

/// The key of "maps" in MATERIALS.json: "stiffness", "friction", "damping".
std::string_view map_key(Quantity quantity) noexcept;

/// One entry of "materials": what a surface looks and feels like. SI units as in the haptic tag.
struct MaterialRule {
  std::string name;
  std::string library;            ///< Id of the library's material that the rule rests on; empty: none.
  std::filesystem::path texture;  ///< Picture of the grain, or the first of height.images; empty: no grain. Absolute or
                                  ///< relative to the working folder.
  std::string recipe;             ///< What the file has as texture, in case it is a recipe or a grain.
  double time = 0;                ///< Of a recipe: 0 new to 1 worn.
  double size_mm[2] = {0, 0};     ///< Width and height that the picture shows; 0: from the picture's own resolution.
  Vec2 phase_mm{0, 0};            ///< Moves the grain on the surface along u and v.
  std::optional<double> stiffness;  ///< N/m
  std::optional<double> damping;    ///< N·s/m
  std::optional<double> static_friction, dynamic_friction, stribeck_velocity;
  std::map<Quantity, MapRule> maps;  ///< Instead of those that a recipe has for the same quantity.
  std::optional<BackingTag> backing;
  std::optional<RoughnessModel> fine_roughness;  ///< Finer than the relief, over which it is laid.
  std::optional<FrictionTag> friction_model;
  std::optional<ForceModelTag> force_model;
  std::optional<bool> force_shading;
  HeightRule height;
  std::string unwrap = "auto";  ///< auto, keep, new, or a method of unwrap_methods(), which gives new uv.
  /// Of new uv: the method's options and the grain's direction, where the file has any.
  std::optional<MethodOptions> unwrap_options;
  std::string show = "auto";  ///< auto (coloured pictures), picture (as base colour), relief (keep the part's colour).
  std::optional<std::string> color;  ///< "#RRGGBB" base colour instead of the scene's own.
  std::optional<double> roughness, metallic;
  std::filesystem::path environment;  ///< Equirectangular picture that it mirrors alone; empty: what the scene does.
};

/// One entry of "assign"; the first one that fits a surface wins.
struct AssignRule : SurfaceSelector {
  std::string material;  ///< Name of an entry of "materials"; empty: leave the surface alone.
};

struct Materials {
  std::map<std::string, MaterialRule> materials;
  std::vector<AssignRule> assign;
  std::vector<DecalRule> decals;     ///< Pictures that are projected onto surfaces.
  std::vector<CarrierRule> replace;  ///< Pictures that stand for surfaces.
  std::string source = "materials";  ///< The file's name in messages.
};

/// Reads MATERIALS.json; relative picture names are taken from the file's own folder. A material that names one of the
/// library, "library:leather/nappa-fine", gets all that rule_of() gives, and then what the file says beside it.
/// @param library  folder of the library; empty: the one that find_material_library() finds.
/// @throws IoError, InvalidInput naming the file and the JSON pointer of the offending value.
Materials read_materials(const std::filesystem::path& path, const std::filesystem::path& library = {});

}  // namespace papilla
