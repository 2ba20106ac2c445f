// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "papilla/texture/height_map.hpp"

namespace papilla {

/// Finer than this is roughness, coarser is relief. Schulze 2005, section 9.1.
inline constexpr double k_longest_roughness_mm = 1;

/// Roughness by its parameters, as the haptic tag carries it.
struct RoughnessModel {
  double hurst = 0.5;                      ///< H of the power law, in (0, 1).
  double rms_slope = 0;                    ///< Root mean square slope of these waves.
  double rms_mm = 0;                       ///< Root mean square height of the waves within the range.
  double shortest_mm = 0, longest_mm = 0;  ///< Range of the wavelengths.
  double anisotropy = 1;                   ///< Along `direction_rad` waves are that many times as long.
  double direction_rad = 0;                ///< From x (right) towards y (down), in (−π/2, π/2].
};

/// The part of a roughness whose waves are no shorter than `shortest_mm`, by its power law
///     ⟨h²⟩ ∝ ∫ k^(−2H) d ln k,   ⟨|∇h|²⟩ ∝ (2π)² ∫ k^(2−2H) d ln k,   k from 1/longest to 1/shortest
/// as the player makes it up (roughness_field.hpp): its rms and slope follow from the rms of the whole. Nothing when
/// all waves are shorter, or the rms is 0. @pre 0 < H < 1, 0 < shortest < longest of `whole`.
std::optional<RoughnessModel> roughness_above(const RoughnessModel& whole, double shortest_mm);

/// What part_roughness() returns.
struct PartedRelief {
  HeightMap relief;                         ///< Without the roughness; with it where none was parted.
  std::optional<RoughnessModel> roughness;  ///< Nothing: the relief is as it was.
  std::string reason;                       ///< One sentence: what the parameters rest on, or why there are none.
};

/// Parts a relief into what is felt as shape and what is felt as roughness: waves of at most `longest_mm` are taken out
/// (Fourier waves of a relief that tiles, cosine waves of one that does not) and described by their root mean square
/// height, the Hurst exponent and the anisotropy of their slopes,
///   √(λ1/λ2)  of the structure tensor ⟨∇h ∇hᵀ⟩, 1 below 1.1,
/// from which the player makes up a surface like it (with_roughness() in roughness_field.hpp). Only where a power law
/// holds (best_dimension()) and the relief has samples for at least two octaves below `longest_mm`; else nothing is
/// parted. Cost: that of best_dimension() and two transforms. Deterministic.
/// @throws InvalidInput when the relief is empty, not finite or without pitch, or `longest_mm` is not positive.
PartedRelief part_roughness(const HeightMap& relief, double longest_mm = k_longest_roughness_mm);

}  // namespace papilla
