// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla {

/// The values of a texture at a point. `color` has three numbers, the others one.
enum class Channel {
  main,
  bump,
  alpha,
  coloralpha,
  reflection,
  diffuse,
  specular,
  specularcoeff,
  friction,
  stiffness,
  damping,
  roughness,
  color
};
inline constexpr int k_channels = 13;
std::string_view to_string(Channel channel) noexcept;
/// @throws InvalidInput naming the channels there are.
Channel channel_named(std::string_view name);

/// The roughness of glTF's metallic-roughness model whose highlight is as high as that of a texture's specular
/// channels, s (1 + specularcoeff / 2) / π of Blinn's halfway vector: r = (2 / (s (n + 2)))^¼, 1 at most, and 1 for s
/// <= 0. At s = 1 it is the usual translation of the exponent. It is the channel `roughness` where a recipe gives none.
/// [Blinn 1977; Walter, Marschner, Li, Torrance: Microfacet models for refraction, 2007: α² = 2 / (n + 2); glTF 2.0,
/// appendix B: α = r²]
/// @param specular  s, weight of the highlight. @param exponent  n; counts as 0 below 0.
double roughness_of_highlight(double specular, double exponent) noexcept;

/// A picture for the type `image`: RGB in [0, 1], interleaved.
struct RecipePicture {
  int width = 0, height = 0;
  std::vector<float> rgb;
};

struct CompileOptions {
  double time = 0;                ///< 0 new … 1 worn.
  double realtime_s = 0;          ///< The value of `realtime`.
  std::uint32_t seed = 0;         ///< Added to the seed of the recipe.
  bool seamless = false;          ///< As if the recipe said seamless=true.
  std::string source = "recipe";  ///< The name of the recipe in messages.
  /// Reads picpath; without it recipes that name a file are refused.
  std::function<RecipePicture(const std::string& path)> read_picture;
  int target_px = 256;  ///< Texels a side of the picture that will be made, for fit2screen. @pre at least 1.
};

namespace procedural_detail {
struct Graph;
}

/// A recipe, compiled: formulas are bytecode with constants folded, names are resolved. A value; copies share the code.
class ProceduralTexture {
 public:
  explicit ProceduralTexture(std::shared_ptr<const procedural_detail::Graph> graph) : graph_(std::move(graph)) {}
  const procedural_detail::Graph& graph() const noexcept { return *graph_; }
  bool depends_on_normal() const noexcept;      ///< normaldot is used somewhere.
  bool depends_on_position() const noexcept;    ///< posx, posy, posz or checker3d is used somewhere.
  bool depends_on_sky() const noexcept;         ///< sky is used somewhere.
  bool depends_on_flow() const noexcept;        ///< flow is used somewhere.
  bool depends_on_time() const noexcept;        ///< time is used somewhere.
  bool depends_on_neighbours() const noexcept;  ///< nearmean() or another neighbourhood function is used somewhere.
  /// The dirt directions of all textures that use normaldot, each once: two normals with the same product with each of
  /// them look the same to the recipe.
  std::vector<std::array<double, 3>> dirt_directions() const;
  std::vector<std::string> recipes_used() const;  ///< Names from the library, sorted.

 private:
  std::shared_ptr<const procedural_detail::Graph> graph_;
};

/// Compiles type|parameter=value|… ; the language is described in docs/procedural.md.
/// Formulas are checked in full here, so that evaluating can't fail.
/// Cost: O(text), and a picture of the type image, ifs, txt is drawn once.
/// @throws InvalidInput naming recipe, line, column and what was expected: unknown types, parameters, functions,
/// recipes,
///         colours; wrong numbers of arguments; numbers out of range; recipes that use themselves; more than 1 MiB of
///         text, 32 levels, 1024 textures or 100 000 evaluations a point.
ProceduralTexture compile_texture(std::string_view recipe, const RecipeLibrary& library,
                                  const CompileOptions& options = {});

/// The places of points in a picture, for nearmean() and the other neighbourhood functions.
struct PointRaster {
  int width = 0, height = 0;          ///< 0: the points have no neighbours. @pre at most 2^26 texels.
  bool repeats = false;               ///< The picture repeats across its borders.
  std::span<const std::uint32_t> at;  ///< row * width + column of every point, each place at most once.
};

/// Points to evaluate at. All spans but `x` and `y` may be empty.
struct TexturePoints {
  std::span<const double> x, y;        ///< Place in the picture: (0, 0) is its top left, (1, 1) its bottom right.
  std::span<const float> normals;      ///< 3 a point, unit length; empty: the recipe's own.
  std::span<const float> positions;    ///< 3 a point, metres, y up; empty: (x, y, 0).
  std::span<const float> sky;          ///< Share of the sky seen; empty: 1.
  std::span<const float> color = {};   ///< 3 a point: what `currentcolor` is below all layers; empty: black.
  std::span<const float> height = {};  ///< What `lowerbump` is there; empty: 0.
  PointRaster raster = {};
  std::span<const float> alpha = {};       ///< What `loweralpha` is below all layers; empty: 0.
  std::span<const float> reflection = {};  ///< The same of `lowerreflection`.
  std::span<const float> roughness = {};   ///< The same of `lowerroughness`.
  std::span<const float> flow = {};        ///< Dirt that flowed there, see StainField; empty: 1.
};

/// channels[c] has one number a point (color three); empty when not asked for.
struct TextureValues {
  std::array<std::vector<float>, k_channels> channels;
  const std::vector<float>& operator[](Channel c) const { return channels[static_cast<std::size_t>(c)]; }
};

struct RenderOptions {
  int width = 256, height = 256;  ///< Texels. @pre 1 to 65536 each, and at most 2^30 in all.
  unsigned channels = 1U << static_cast<unsigned>(Channel::main);  ///< Bits by Channel.
  ProgressCallback progress;
  double shift_x = 0, shift_y = 0;  ///< Texels by which the points lie off the texels' centres.
};

struct RenderedTexture {
  int width = 0, height = 0;
  TextureValues values;  ///< Row by row from the top left; texel (i, j) is evaluated at its centre.
};

/// The channels as pictures. The shorter side spans 1 unless the recipe says stretch.
/// Every value is finite: intermediate results that are not count as 0. Alpha, coloralpha, roughness and colours
/// are cut to [0, 1], friction, stiffness and damping to [0, 10]. Cost: O(texels), once more for every neighbourhood
/// statistic that rests on another one; all cores (TBB). Deterministic, whatever the number of threads.
/// @throws InvalidInput when the size breaks its precondition, or a recipe with neighbourhoods exceeds 2^26 texels.
RenderedTexture render_texture(const ProceduralTexture& texture, const RenderOptions& options);

/// The same at any points. `texel` is the distance of neighbouring points, for the choice of octaves; 0: all octaves.
/// @throws InvalidInput when the spans have unlike lengths, or the raster breaks its precondition.
TextureValues evaluate_texture(const ProceduralTexture& texture, const TexturePoints& points, unsigned channels,
                               double texel);

/// The height channel as relief: bump times depth_mm.
/// @throws InvalidInput as render_texture(), or when size_mm or depth_mm is not positive.
HeightMap render_relief(const ProceduralTexture& texture, int width, int height, double size_mm_x, double size_mm_y,
                        double depth_mm);

}  // namespace papilla
