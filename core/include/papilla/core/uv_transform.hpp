// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include "papilla/core/vec.hpp"

namespace papilla {

/// KHR_texture_transform: uv' = offset + R(rotation) · diag(scale) · uv, with uv in glTF's own space (v down, origin at
/// the picture's upper left).
struct UvTransform {
  Vec2 offset{0, 0};
  double rotation = 0;  ///< Radians; turns the uv counter-clockwise as seen with v down.
  Vec2 scale{1, 1};
  friend bool operator==(const UvTransform&, const UvTransform&) = default;

  /// The rows of diag(width, height) · R(rotation) · diag(scale): uv to texels of a picture of that size.
  std::array<Vec2, 2> rows(double width = 1, double height = 1) const noexcept {
    const double c = std::cos(rotation), s = std::sin(rotation);
    return {Vec2{width * c * scale.x, width * s * scale.y}, Vec2{-height * s * scale.x, height * c * scale.y}};
  }
};

/// Applies the transform to texture coordinates with v up, as those of a Scene; the result has v up, too.
inline Vec2 transform_uv(const UvTransform& transform, Vec2 uv) noexcept {
  const std::array<Vec2, 2> rows = transform.rows();
  const Vec2 down{uv.x, 1 - uv.y};
  return {dot(rows[0], down) + transform.offset.x, 1 - (dot(rows[1], down) + transform.offset.y)};
}

}  // namespace papilla
