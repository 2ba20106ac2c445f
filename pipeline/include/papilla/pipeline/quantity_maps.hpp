// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "papilla/core/values.hpp"
#include "papilla/haptic/channel_field.hpp"
#include "papilla/haptic/material_tag.hpp"

namespace papilla {

/// What a quantity is at every texel, row by row: in its SI unit, or in multiples of a material's constant.
struct QuantityMap {
  Quantity quantity = Quantity::stiffness;
  Values<float> values;  ///< ≥ 0
};

/// Up to three maps over one picture, no two of the same quantity.
struct QuantityMaps {
  int width = 0, height = 0;
  double pitch_mm_x = 0, pitch_mm_y = 0;
  bool periodic = false;  ///< As of HeightMap.
  std::vector<QuantityMap> maps;
};

/// Texels of a map that is written measure at least half of this: a fingertip tells places a millimetre apart.
inline constexpr double k_map_texel_mm = 0.2;

/// Largest slope of the logarithm of a stiffness that is written, per millimetre: 1/(2 mm), at which a probe that is
/// pressed as deep as reliefs are made for (k_felt_depth_m) is drawn to the softer side with half of the normal force.
/// Up to there the player's spring gives back no more than was put in (proxy.hpp).
inline constexpr double k_steepest_stiffness_per_mm = 0.5;

/// The maps as a picture of 8 bits a sample, each from its least value, black, to its largest, white: steps of 0.4 % of
/// the range, of which people tell a few per cent apart. Maps that are nowhere more than 0.1 % off their mean are left
/// out; nothing is left of constant ones. Texels are averaged while they are finer than k_map_texel_mm/2, and stiffness
/// is smoothed by limit_slope() where it is steeper than k_steepest_stiffness_per_mm. Cost: linear, and that of
/// limit_slope().
/// @throws InvalidInput when sizes disagree, a value is negative or not finite, or there are more than three maps.
std::optional<MapsTag> encode_quantity_maps(QuantityMaps maps);

/// From maps in multiples of the constants to those in their units. A channel of a constant that is 0 is left out, and
/// the member without a channel with it.
/// @returns the quantities that were left out.
std::vector<Quantity> scale_by_constants(std::optional<MapsTag>& maps, const MaterialTag& constants);

}  // namespace papilla
