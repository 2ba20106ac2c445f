// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "papilla/haptic/height_field.hpp"

namespace papilla {

/// Number of the texel i of n along an axis, outside of [0, n) by the wrap mode.
inline long wrapped(long i, long n, Wrap mode) noexcept {
  if (i >= 0 && i < n) return i;
  switch (mode) {
    case Wrap::clamp: return std::clamp(i, 0L, n - 1);
    case Wrap::mirror: {
      const long m = ((i % (2 * n)) + 2 * n) % (2 * n);
      return m < n ? m : 2 * n - 1 - m;
    }
    case Wrap::repeat: break;
  }
  const long m = i % n;
  return m < 0 ? m + n : m;
}

/// A texel coordinate that fits an integer; 0 for one that is not finite.
inline double texel_coordinate(double value) noexcept {
  constexpr double k_largest_texel = 1e9;
  return std::isfinite(value) ? std::clamp(value, -k_largest_texel, k_largest_texel) : 0;
}

}  // namespace papilla
