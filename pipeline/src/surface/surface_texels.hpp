// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/meshing/sky.hpp"
#include "papilla/meshing/stain_transport.hpp"

namespace papilla {

/// A triangle that shows a material, where it stands in the scene.
struct SurfaceTriangle {
  std::array<Vec2, 3> uv;                ///< In repeats of the picture, v down its rows.
  std::array<Vec3, 3> position, normal;  ///< Metres, y up; normals of any length.
  std::size_t instance = 0, triangle = 0;
  Triangle uv_index{}, position_index{};  ///< Into the part's uv values and positions.
};

/// All triangles of a material that have texture coordinates.
/// @param colour  the picture whose channel and transform count; null: channel 0 as it stands.
std::vector<SurfaceTriangle> surface_of(const Scene& scene, std::span<const Instance> all, std::uint32_t material,
                                        const TextureReference* colour);

/// Millimetres on the surface per repeat: the root of the area's quotient; 0 when the uv have no area.
double mm_per_repeat(std::span<const SurfaceTriangle> surface);

/// A window of texels and what is known of the surface behind each. Texel (i, j) is the square
/// [left + i, left + i + 1] x [top + j, top + j + 1] of the plane of uv times texels per repeat.
struct SurfaceTexels {
  SurfaceTexels(int left_, int top_, int width_, int height_, bool repeats_);
  std::size_t count() const { return covered.size(); }
  /// The texel at a place of the plane; @pre repeats or within the window.
  std::size_t at(int x, int y) const;
  int left, top, width, height;
  bool repeats;  ///< The window is one repeat and goes on round its borders.
  std::vector<unsigned char> covered;
  std::vector<float> normals, positions;  ///< Three a texel; unit normals, metres.
};

/// What a recipe looks at.
struct SurfaceReading {
  std::vector<std::array<double, 3>> directions;  ///< Only the normal's products with these count.
  bool position = false, sky = false;
};

/// The texels whose centres the triangle covers learn normal and position; the first triangle at a texel decides.
/// @returns how many centres lie inside of this triangle and belong to another one that does not look the same to
/// the recipe, by more than 1/1000 (of a unit, of a metre). Cost: O(texels of the triangle's box).
std::size_t draw(SurfaceTexels& texels, const SurfaceTriangle& triangle, double texels_per_repeat,
                 const SurfaceReading& reading);

/// Texels next to what is covered take over what their neighbour knows, ring by ring.
void grow(SurfaceTexels& texels, int rings);

/// What hides the sky in a scene: all its parts, as they stand, y up.
SkyView sky_of(const Scene& scene, std::span<const Instance> all, int rays);

/// Where dirt flows in a scene: all its parts, as they stand, y up.
StainField stains_of(const Scene& scene, std::span<const Instance> all);

/// The dirt that flowed to a covered texel.
double flow_at(const StainField& stains, const SurfaceTexels& texels, std::size_t at);

/// The sky at every covered texel, 0 at the others. Rays are cast for one texel of each block of 8 x 8 and
/// interpolated between the blocks of the window. Cost: rays / 64 sight lines a texel, all cores.
std::vector<float> sky_texels(const SurfaceTexels& texels, const SkyView& sky);

}  // namespace papilla
