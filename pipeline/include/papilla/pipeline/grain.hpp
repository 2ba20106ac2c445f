// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "papilla/core/deadline.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/slope_limit.hpp"
#include "papilla/texture/texture_class.hpp"

namespace papilla {

class StageCache;

/// Longer pictures are read at a whole fraction of their size, which is still finer than a relief may be.
inline constexpr int k_most_grain_side = 2048;

/// How a grain's relief was found.
struct GrainHeight {
  std::string method, reason;      ///< A HeightMethod's name, "synthesis", "recipe" or "grain".
  std::optional<Vec3> light = {};  ///< Of shape from shading; nothing for recipes.
  bool light_estimated = false;
  double depth_mm = 0, rms_mm = 0;  ///< Peak to valley; root mean square about the mean; of the relief as it is baked.
  StopReason stop = StopReason::direct;
  double unlimited_depth_mm = 0;               ///< Peak to valley before its slopes were limited.
  double max_slope = 0;                        ///< The limit of the slopes, mm per mm.
  SlopeLimitResult slopes = {};                ///< What limiting them changed; its relief is the grain's.
  std::vector<std::string> photographs = {};   ///< Of one place, when it is the relief of several.
  std::optional<StereoFiles> stereo = {};      ///< Of those, without map and confidence.
  std::optional<RoughnessModel> overlay = {};  ///< Roughness that the player lays over the relief.
};

/// The lattice of a grain that repeats.
struct GrainLattice {
  std::string group;  ///< Wallpaper group.
  std::array<Vec2, 2> period_mm{};
};

/// What the picture of a material becomes: relief to be felt, the same relief to be seen, and how the picture is shown.
struct Grain {
  std::string source;          ///< The picture's file, or the recipe.
  ColorImage photograph;       ///< The source as a picture, whether shown or not.
  Vec2 photograph_mm{0, 0};    ///< What all of it shows; the relief may be a tile of that.
  double size_mm[2] = {0, 0};  ///< What one repeat of the relief measures, and of the picture when it is shown.
  bool tiles = false;          ///< The picture's borders match.
  bool solid = false;          ///< Its recipe reads position, normal or sky: a scene gets an atlas of it.
  bool monochrome = false;
  TextureClass kind;
  AnalysisPlan plan;  ///< What the class made of the picture, step by step; empty for recipes.
  std::optional<GrainLattice> lattice;
  GrainHeight height;
  Roughness roughness;                  ///< Of the relief.
  HeightMap relief;                     ///< Scaled by the rule's height.scale, within the limits of height and slope.
  EncodedImage height_png;              ///< 16-bit grey; decoded by MaterialTag::height.
  EncodedImage normal_png;              ///< From the same relief.
  std::optional<EncodedImage> picture;  ///< The base colour, when the picture is to be shown.
  MaterialTag tag;                      ///< Height, roughness, symmetry, provenance; constants come from the rule.
  std::optional<EncodedImage> shine;    ///< Metallic-roughness of a recipe's channels, shown with the picture.
  /// Factors of roughness and metallic that go with the picture of a recipe.
  std::optional<double> roughness_factor, metallic_factor;
  double stiffness_factor = 1, damping_factor = 1;  ///< Means of a recipe's channels.
  std::vector<std::string> warnings;                ///< What of the rule could not be done.
  double analyze_seconds = 0, height_seconds = 0, normal_map_seconds = 0;
};

/// What becomes of the picture of a material.
struct GrainPlan {
  std::string material;
  AnalysisPlan steps;   ///< Empty for recipes.
  std::string problem;  ///< Why make_grain() would fail.
};

/// What make_grain() would do with the picture of a rule, by its class. Only what the decisions rest on is computed.
GrainPlan plan_grain(const MaterialRule& rule, const RecipeLibrary& library = RecipeLibrary::builtin());

/// Largest slope of a relief for a material of static friction μ: 1/(3μ), at most 1. A relief holds a point without
/// sliding where its slope is 1/μ, and a probe that is pushed up a slope s with friction μ feels
/// (s + μ)/(1 − s·μ) of the normal force along the surface: at s = 1/(3μ) that is 1.5·μ + 1/(2μ).
double default_max_slope(double static_friction);

/// Analyses the rule's picture and turns it into relief by its class (relief_of_picture()); a recipe is computed at the
/// rule's time. Heights beyond what a tag may have (tag_limits.hpp) are shrunk or moved with a warning, slopes beyond
/// the rule's are limited by limit_slope().
/// @param library  what recipes may name. @param deadline of searches in the picture: what they leave out is a warning.
/// @param cache  remembers grains by rule, recipes and the bytes of the pictures; null: none.
/// @throws IoError, InvalidInput naming the picture or the place in the recipe.
Grain make_grain(const MaterialRule& rule, const RecipeLibrary& library = RecipeLibrary::builtin(),
                 const Deadline& deadline = {}, const StageCache* cache = nullptr);

/// What of make_grain() is seen and felt, sooner: of recipes and test grains, whose relief is computed, class,
/// lattice and fractal dimension are not looked for, unless the cache knows them. All else is the same.
/// @throws as make_grain().
Grain make_shown_grain(const MaterialRule& rule, const RecipeLibrary& library = RecipeLibrary::builtin(),
                       const Deadline& deadline = {}, const StageCache* cache = nullptr);

/// The tag of a surface: of its grain, which may be null, and the rule's constants.
/// @param kept_mm_per_unit  of uv that stay, on which a transform brings the grain to its scale; 0: the uv are repeats.
MaterialTag surface_tag(const MaterialRule& rule, const Grain* grain, double kept_mm_per_unit);

/// The transform of uv of `mm_per_unit` to repeats of the grain, moved by the rule's phase.
UvTransform transform_to_repeats(const MaterialRule& rule, const Grain& grain, double mm_per_unit);

/// Copies the rule's haptic constants into a tag. @param stiffness_factor, damping_factor  multiply them, the rule's or
/// the tag's own.
void apply_constants(const MaterialRule& rule, MaterialTag& tag, double stiffness_factor = 1,
                     double damping_factor = 1);

}  // namespace papilla
