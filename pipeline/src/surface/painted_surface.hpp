// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "papilla/meshing/stain_transport.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/image.hpp"
#include "surface/atlas_uv.hpp"
#include "surface/surface_atlas.hpp"

namespace papilla {

/// The channels of a recipe as pictures of a surface, row by row. Colours and shine are as glTF stores them.
struct SurfacePicture {
  int width = 0, height = 0;
  std::vector<unsigned char> rgba;   ///< Base colour: the colour times diffuse where it is no metal; alpha.
  std::vector<unsigned char> shine;  ///< Roughness and metallic, two a texel.
  std::vector<float> bump, friction, stiffness, damping;

  SurfacePicture() = default;
  /// What is between the charts: middle grey and height, and the friction.
  SurfacePicture(int width_px, int height_px, float friction_between);
  std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  friend bool operator==(const SurfacePicture&, const SurfacePicture&) = default;
};

/// Mean, least and largest value of a channel where something shows it.
struct ChannelRange {
  double sum = 0, weight = 0, low = 1e300, high = -1e300;
  void add(double value, double times);
  double mean() const { return weight > 0 ? sum / weight : 0; }
  /// By less than a picture of 8 bits tells.
  bool is_constant() const { return !(high - low > 0.5 / 255); }
};

struct SurfaceRanges {
  ChannelRange friction, stiffness, damping, roughness, metallic, alpha;
};

/// What a surface is painted with.
struct PaintJob {
  const ProceduralTexture& texture;
  const ProceduralTexture& tiling;     ///< The same recipe, seamless, for one repeat that goes on round its borders.
  const SurfaceReading& reading;       ///< Of the recipe, for which the surface was laid out.
  const OwnSurface* own = nullptr;     ///< What lies below all layers; null: nothing.
  const StainField* stains = nullptr;  ///< Must be given to a recipe that reads `flow`.
  double depth_mm = 1;                 ///< Of a height of 1, for the own relief.
  double friction = 0;                 ///< Between the charts.
  bool share_equal = true;             ///< Charts that come out alike share their texels.
  std::function<void(double)> progress = [](double) {};  ///< Called with the share that is painted.
};

/// A surface as it was painted.
struct PaintedSurface {
  SurfacePicture picture;
  SurfaceRanges ranges;
  double texels_per_repeat = 0;
  bool repeats = false;            ///< The picture is one repeat of the coordinates that there are.
  std::vector<NewUv> uv;           ///< Else: those of the atlas.
  std::size_t distinct_tiles = 0;  ///< Of the atlas.
};

/// Evaluates the recipe at every texel that the surface shows: one repeat, or the charts of an atlas.
/// @pre mm_per_repeat of the surface is positive. Cost: that of evaluate_texture() for every texel.
PaintedSurface paint_surface(const MaterialSurface& shown, const PaintJob& job);

/// The coordinates of the picture that paint_surface() makes without share_equal, whatever the recipe: of its atlas, or
/// of the one repeat. @pre mm_per_repeat of the surface is positive.
std::vector<NewUv> uv_of_own_tiles(const MaterialSurface& shown);

/// A recipe's picture as one repeat of a surface; rendered with painted_channels().
PaintedSurface painted_repeat(const RenderedTexture& rendered);
unsigned painted_channels() noexcept;

/// Roughness and metallic as a glTF material has them: factors, and a picture that they multiply.
struct Shine {
  std::optional<ColorImage> picture;  ///< Roughness in green, metallic in blue, 1 where it is the factor alone.
  double roughness = 1, metallic = 1;
};

/// @param roughness, metallic  instead of the surface's own. @return no picture where both are constant.
Shine shine_of(const PaintedSurface& surface, std::optional<double> roughness = {},
               std::optional<double> metallic = {});

/// The base colour without alpha.
ColorImage color_of(const SurfacePicture& picture);

/// The pixels as RGBA, opaque.
std::vector<unsigned char> with_alpha(const ColorImage& image);

/// The base colour as PNG, with alpha where that differs from place to place.
std::vector<std::byte> encode_color(const PaintedSurface& surface);

/// What a recipe looks at.
SurfaceReading reading_of(const ProceduralTexture& texture);

}  // namespace papilla
