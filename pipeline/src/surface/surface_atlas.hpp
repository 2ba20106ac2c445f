// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/meshing/sky.hpp"
#include "surface/own_surface.hpp"
#include "surface/surface_texels.hpp"

namespace papilla {

/// Rings of texels around a chart that go on with its recipe, so that filtering never meets a neighbour.
inline constexpr int k_gutter = 4;

/// A piece of surface to be painted once.
struct AtlasTile {
  SurfaceTexels texels;
  std::vector<float> sky;  ///< Empty when the recipe does not read it.
  std::size_t charts = 0;  ///< How many show it.
};

/// Where a chart's texels are.
struct AtlasChart {
  int left = 0, top = 0;  ///< Of its window, in texels of the plane of its uv.
  std::uint32_t tile = 0;
};

/// A material's surface, cut into charts, none with a texel that two unlike places share: pieces connected by position
/// and uv; those that overlap, into their flat pieces; and those of them that still do, into triangles.
struct SurfaceAtlas {
  double texels_per_repeat = 0;
  std::vector<AtlasTile> tiles;  ///< Charts that look the same to the recipe share one.
  std::vector<AtlasChart> charts;
  std::vector<std::uint32_t> chart_of;  ///< A number a triangle.
};

/// Charts that have the same window, outline and readings (products with the directions in steps of 1/2048, positions
/// in steps of 0.1 mm if they are read, sky in steps of 1/256) share a tile, found by a hash (SHA-256) of these
/// numbers. The resolution is `texels_per_repeat`, or less, down to 1/1000 of it, when the tiles would exceed the
/// texels of a picture of `most_side` a side, or one is longer than 8192. Charts so many that their gutters alone
/// exceed that get up to 2^26 texels. Cost: O(texels), and the sky. Deterministic.
/// @param sky  null when it is not read.
/// @throws InvalidInput when there are more charts than fit, or uv that are not finite.
SurfaceAtlas cut_surface(std::span<const SurfaceTriangle> surface, double texels_per_repeat, int most_side,
                         const SurfaceReading& reading, const SkyView* sky);

/// Where the tiles lie.
struct TilePlaces {
  int width = 0, height = 0;
  std::vector<std::pair<int, int>> corner;  ///< Upper left one.
};

/// Packs windows of the given sizes into a nearly square picture.
TilePlaces place_tiles(std::span<const std::pair<int, int>> sizes);

/// All that painting a material needs to know of the scene; the same at any time and for any recipe with this reading.
struct MaterialSurface {
  std::vector<SurfaceTriangle> triangles;
  double mm_per_repeat = 0;             ///< 0: nothing with uv shows the material, and nothing else is known.
  std::optional<OwnSurface> own;        ///< Of add_own_surface().
  std::optional<SurfaceTexels> repeat;  ///< One repeat, where no texel is shown by two unlike places.
  std::vector<float> sky;               ///< Of `repeat`; empty when it is not read.
  SurfaceAtlas atlas;                   ///< Else.
  bool keeps_relief = false;       ///< The atlas is coarser than asked for, and the own relief's coordinates are kept.
  bool leaves_the_repeat() const;  ///< Some uv lie outside of [0, 1].
  std::size_t texels() const;
};

/// @param place  as of surface_of(). @param size  texels a repeat. @param atlas_side  texels a side of an atlas at
/// most.
/// @param sky  is called if the reading asks for it.
MaterialSurface lay_out(const Scene& scene, std::span<const Instance> all, std::uint32_t material,
                        const TextureReference* place, int size, int atlas_side, const SurfaceReading& reading,
                        const std::function<const SkyView&()>& sky);

/// Adds what the material has of its own to a surface that was laid out at own_place().
/// @pre mm_per_repeat is positive. @throws InvalidInput as OwnSurface.
void add_own_surface(const Scene& scene, std::span<const Instance> all, std::uint32_t material, int size,
                     MaterialSurface& surface);

}  // namespace papilla
