// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "papilla/haptic/channel_field.hpp"

namespace papilla {

/// The texels of maps as a ball feels them: what touches is no point, so that every sample becomes the mean of those
/// within the radius along both axes of the map, (2n + 1)² texels with n the radius in texels, rounded, at most half of
/// the map. Bounds the slopes: a step is felt over 2·radius. The mean of a map that repeats stays within a step of 16
/// bits. Cost: texels, whatever the radius.
/// @param samples width × height, both above 0, row by row. @param radius_m of 0 or less changes nothing.
/// @param metres_per_uv length of a unit of u and of v; 0 along an axis: no mean along it.
std::vector<ChannelField::Texel> average_texels(std::vector<ChannelField::Texel> samples, int width, int height,
                                                const UvTransform& transform, const std::array<Wrap, 2>& wrap,
                                                double radius_m, Vec2 metres_per_uv);

}  // namespace papilla
