// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla::texture_detail {

/// @throws InvalidInput naming `function` when the picture is empty, its buffer has the wrong size,
///         a value is not finite, or a side is below `least_side`.
void require_image(const GreyImage& image, const char* function, int least_side = 1);

/// The same for a relief; with `needs_pitch` its pitch must be positive too.
void require_height_map(const HeightMap& map, const char* function, bool needs_pitch);

/// The direction with length 1. @throws InvalidInput when it is not finite, is zero or points away from the viewer (z ≤
/// 0).
Vec3 require_light(Vec3 light, const char* function);

/// The index of `name` among the names of an enumeration's values, in their order.
/// @throws InvalidInput naming `function` and all names.
std::size_t index_of_name(std::string_view name, std::span<const std::string_view> names, const char* function);
/// Finite and above 0.
inline bool is_positive(double value) { return std::isfinite(value) && value > 0; }

/// The picture stretched to 0…255 and rounded; all 0 when it has a single value.
std::vector<std::uint8_t> stretched_bytes(const GreyImage& image);

/// The picture in whole steps of 1/255; empty when a value is none, or lies outside [0, 1].
std::vector<std::uint8_t> whole_bytes(const GreyImage& image);

/// Index of a sample in a row-by-row array.
inline std::size_t pixel_index(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

/// x modulo n in [0, n).
inline int wrapped(int x, int n) {
  const int rest = x % n;
  return rest < 0 ? rest + n : rest;
}

}  // namespace papilla::texture_detail
