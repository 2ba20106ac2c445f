// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

namespace papilla {

/// The linear value of an sRGB-encoded one (IEC 61966-2-1); both in [0, 1], clamped.
inline double linear_from_srgb(double c) {
  c = std::clamp(c, 0.0, 1.0);
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// The inverse of linear_from_srgb().
inline double srgb_from_linear(double c) {
  c = std::clamp(c, 0.0, 1.0);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

}  // namespace papilla
