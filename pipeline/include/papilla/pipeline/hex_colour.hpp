// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

namespace papilla {

/// "#rrggbb" in sRGB of a linear colour.
std::string hex_colour(const std::array<double, 4>& linear);

/// A linear colour of "#rrggbb" in sRGB, opaque.
/// @throws InvalidInput when it has not seven characters, '#' first. @pre The others are hexadecimal digits.
std::array<double, 4> linear_colour(const std::string& hex);

}  // namespace papilla
