// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla {

/// A relief as the height of a haptic tag: 16 bits, in a data: URI, metres_per_uv a repeat of the relief.
/// @throws InvalidInput when the relief is empty or a height is not finite.
HeightTag height_tag_of(const HeightMap& relief);

/// Gives a tagged material a relief that lies on the coordinates of its normal map; other materials stay.
void assign_relief(Material& material, HeightTag height);

}  // namespace papilla
