// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "papilla/core/vec.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Blinn and Phong's highlights, strength · max(0, n·h)^shininess, h halfway between light and viewer.
struct SpecularPart {
  double strength = 0;    ///< Of a mirror-like facet, against the albedo 1 of a white one; at least 0.
  double shininess = 30;  ///< Exponent, at least 1.
};

/// Options of photograph(). Shares are of 1; brightness is linear until the transfer curve.
struct PhotographOptions {
  Vec3 light{-0.5, -0.5, 0.7071067811865476};  ///< Direction to the light, any length, z > 0; x right, y down.
  double ambient = 0.1;            ///< Share of the light that comes from everywhere, without shadows, in [0, 1).
  bool cast_shadows = true;        ///< False: only surfaces that face away from the light are dark.
  SpecularPart specular = {};      ///< Highlights; they do not depend on the albedo.
  double albedo_noise = 0;         ///< Rms of the albedo's relative spots that are free of the height, in [0, 0.5].
  double albedo_spot_px = 2;       ///< Radius (standard deviation) of those spots.
  double valley_darkening = 0;     ///< The lowest point's albedo is lower by this share than the highest point's.
  double vignette = 0;             ///< Loss at the corners; falls with the square of the distance from the centre.
  double uneven_light = 0;         ///< Light changes linearly by ± this share from one border to the opposite one.
  double blur_px = 0;              ///< Standard deviation of the Gaussian point spread.
  double noise = 0;                ///< Standard deviation of the sensor's noise, of white.
  double mean_grey = 0.35;         ///< Linear exposure: the mean, or less where that would clip.
  double clipped = 0.002;          ///< At most this share of the pixels is over white.
  bool srgb = true;                ///< False: the picture stays linear.
  int bits = 8;                    ///< 8: rounded to whole steps of 1/255; 32: not rounded.
  std::uint64_t surface_seed = 1;  ///< Of the albedo's spots: the same for all pictures of one surface.
  std::uint64_t seed = 1;          ///< Of the noise and of the direction in which the light changes.
};

/// What photograph() returns.
struct Photograph {
  GreyImage picture;            ///< In [0, 1], with the pitch of the relief.
  double shadows_fraction = 0;  ///< Pixels that the light does not reach, by attached or cast shadows.
  double clipped_fraction = 0;  ///< Pixels at white.
};

/// Picture that a camera above a relief takes of it. For every sample, with the normal n by central differences
/// (one-sided at open borders), the light s, its visibility V and the albedo a,
///   L = a · (ambient + (1 − ambient) · V · max(0, n·s)) + (1 − ambient) · V · strength · max(0, n·h)^shininess,
/// then times uneven light and vignette, smoothed by the point spread, scaled to the exposure, plus noise, through the
/// transfer curve, and rounded. V is 0 where the relief rises above the line to the light, found by steps of one sample
/// along it (bilinear heights; around the borders of a periodic relief, past the borders of another nothing shades),
/// else
/// 1. No light is scattered from one facet to another, and the point spread stops at the borders.
/// Cost: O(samples · (1 + range of the heights / (pitch · tan elevation))). Deterministic for given seeds.
/// @throws InvalidInput when the relief is empty, not finite or without a pitch that is the same in x and y, or an
/// option is out of range.
/// Blinn, Models of light reflection for computer synthesized pictures, 1977.
Photograph photograph(const HeightMap& relief, const PhotographOptions& options = {});

/// The three conditions that relief from photographs is measured under: a clean matt surface; 8 % spots of the albedo
/// and ±15 % uneven light; valleys darker by 15 % with highlights of strength 0.25. All with 0.7 px blur, 1 % noise, 10
/// % vignette and 8 bits in sRGB.
enum class PhotographCondition { clean, spotted, glossy };

/// The options of a condition, under a light of random azimuth, 25 to 55 degrees above the surface. Every seed gives
/// other light, noise and spots, whose radius lies within 1 to 8 pixels.
PhotographOptions photograph_options(PhotographCondition condition, std::uint64_t seed);
/// One of several photographs of a surface: all of the same `surface_seed` show the same spots.
PhotographOptions photograph_options(PhotographCondition condition, std::uint64_t seed, std::uint64_t surface_seed);

}  // namespace papilla
