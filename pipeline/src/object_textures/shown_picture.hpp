// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/rgba_image.hpp"
#include "papilla/pipeline/object_texture_rules.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla {

/// The rule's picture, cut out, and with its contrast. @throws IoError, InvalidInput as read_rgba_image().
RgbaImage read_carrier_picture(const CarrierRule& rule);

/// glTF's alphaMode of a picture: OPAQUE without alpha, MASK when at most one pixel in a hundred is neither transparent
/// nor opaque, else BLEND.
std::string alpha_mode_of(const RgbaImage& image);

/// The relief that a rule makes of a picture of `width_mm` × `height_mm`, lowest place 0, before its slopes are
/// limited. Pictures longer than 1024 pixels are reduced, by whole pixels.
/// @throws IoError, InvalidInput as read_rgba_image().
HeightMap relief_of_shown_picture(const ObjectRelief& rule, const RgbaImage& shown, double width_mm, double height_mm);

/// A relief as it is felt and seen.
struct FeltRelief {
  HeightMap relief;
  HeightTag tag;  ///< Clamped beyond uv 0 to 1.
};

/// Limits the slopes and codes the relief. @param base_mm  is added to the heights that are felt.
FeltRelief felt_relief(const HeightMap& relief, double max_slope, double base_mm);

}  // namespace papilla
