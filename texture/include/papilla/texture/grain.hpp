// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Test grains: on a square tile, elements of equal shape and height on level ground.
///   spheres6, spheres8  36 or 64 sphere segments on a square lattice
///   quads6, quads8      36 or 64 square blocks with rounded edges on a square lattice
///   ovals6, ovals8      55 or 85 ellipsoid segments, five a row, each row moved on by nearly half an element (5/11 or
///                       8/17 of the distance, so that an odd number of rows tiles exactly)
///   sine                product of two sines, 8 × 8 periods
///   gaussian            normally distributed heights whose correlation falls like a Gaussian over 0.5 mm
///   fourier             Fourier series of up to 12 waves a side with random phases, amplitudes falling as 1/waves
///   leather             statistical: irregular domed pebbles of about 1.7 mm with creases of varying depth, fine
///                       wrinkles, and fractal roughness below 1 mm wavelength
enum class GrainKind { spheres6, spheres8, quads6, quads8, ovals6, ovals8, sine, gaussian, fourier, leather };

/// The kind's name as above.
std::string_view to_string(GrainKind kind) noexcept;
/// The kind of that name. @throws InvalidInput for any other name, listing the known ones.
GrainKind grain_kind(std::string_view name);
/// All names, in the order of the enumeration.
std::vector<std::string_view> grain_names();

/// Options of synthesize_grain().
struct GrainOptions {
  int size_px = 512;                           ///< Samples a side, 16 to 8192.
  double size_mm = 40;                         ///< Side of the tile.
  double height_mm = 0.3;                      ///< Peak to valley.
  Vec3 light{-0.5, -0.5, 0.7071067811865476};  ///< For the picture: x right, y down, z to the viewer.
  std::uint64_t seed = 1;                      ///< Of gaussian, fourier and leather.
};

/// What synthesize_grain() returns.
struct GrainResult {
  HeightMap relief;   ///< 0 to height_mm, exactly periodic.
  GreyImage picture;  ///< render_lambert() of the relief: the truth for shape from shading.
};

/// A grain as relief and as lit picture. Deterministic for given options.
/// Cost: O(samples); leather about 0.2 s at 512².
/// @throws InvalidInput when an option is out of range.
/// Schulze 2005, sections 8.2 and 8.3 (spheres, quads, ovals) and 5.4 (sine, gaussian, fourier: the reliefs of
/// Massie, of Siira and Pai, of Basdogan); Worley, A cellular texture basis function, 1996
/// (leather).
GrainResult synthesize_grain(GrainKind kind, const GrainOptions& options = {});

}  // namespace papilla
