// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/procedural/texture.hpp"

namespace papilla {

/// The light that a recipe is looked at in: its parameters shade, pointlight, lightdist, lightx, lighty, lightz,
/// lightscale, ambient and quickshade. Of the texture that is shown; those of textures within it do not count.
struct PreviewLight {
  bool shade = true;            ///< False: the colours as they are.
  bool at_a_point = false;      ///< (x, y, z) is a place, else the direction to the light.
  bool falls = false;           ///< With the square of the distance to the place, 1 at one side of the picture.
  bool from_neighbours = true;  ///< Slopes from the neighbouring texels; false: from half a texel to either side.
  double x = 0.5, y = 0.5,
         z = 1;  ///< x right, y up, z to the viewer. A place: (±1, ±1) are the picture's corners, z in sides.
  double scale = 1, ambient = 0;  ///< Of the light, of light from everywhere.
};
PreviewLight preview_light(const ProceduralTexture& texture) noexcept;

/// The channels that light_texture() needs.
inline constexpr unsigned k_preview_channels =
    1U << static_cast<unsigned>(Channel::color) | 1U << static_cast<unsigned>(Channel::bump) |
    1U << static_cast<unsigned>(Channel::diffuse) | 1U << static_cast<unsigned>(Channel::specular) |
    1U << static_cast<unsigned>(Channel::specularcoeff);

/// A picture of the texture in the light of its recipe, three numbers a texel in [0, 1]:
///
///     I = color (ambient + s diffuse max(0, N . L)) + s specular max(0, R . A)^specularcoeff
///
/// with the normal N of the bump channel, L to the light, R its reflection about N, A to the viewer, and s = scale,
/// over the squared distance where the light falls. One white light, no shadows. Slopes reach across the border to the
/// other side of the picture, so that a tile stays one.
/// @param rendered  of `texture`. @pre it has k_preview_channels.
/// @param relief  height of a bump of 1, in texels.
/// Cost: O(texels); four more pictures of the height where the slopes are not the neighbours'.
/// Source: [Phong 1975], as the texture editor of 2006 has it.
std::vector<float> light_texture(const ProceduralTexture& texture, const RenderedTexture& rendered, double relief);

}  // namespace papilla
