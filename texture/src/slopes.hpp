// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "papilla/core/vec.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla::texture_detail {

/// Central difference along one axis of samples `before`, `after` around i, one-sided at open borders.
struct Stencil {
  int before, after, span;
};

inline Stencil stencil(int i, int count, bool periodic) {
  if (periodic) return {i > 0 ? i - 1 : count - 1, i + 1 < count ? i + 1 : 0, 2};
  const int before = std::max(0, i - 1), after = std::min(count - 1, i + 1);
  return {before, after, std::max(1, after - before)};
}

/// (∂h/∂x, ∂h/∂y), y down, in millimetres per millimetre.
inline Vec2 slope(const HeightMap& map, int x, int y) {
  const Stencil across = stencil(x, map.width, map.periodic), down = stencil(y, map.height, map.periodic);
  const double dx = static_cast<double>(map.at(across.after, y)) - static_cast<double>(map.at(across.before, y));
  const double dy = static_cast<double>(map.at(x, down.after)) - static_cast<double>(map.at(x, down.before));
  return {dx / (across.span * map.pitch_mm_x), dy / (down.span * map.pitch_mm_y)};
}

}  // namespace papilla::texture_detail
