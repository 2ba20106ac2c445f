// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>

namespace papilla {

/// Meshes, uv of charts and height maps are in millimetres; glTF, the haptic tag and
/// everything in `haptic` are in SI units.
inline constexpr double k_metres_per_mm = 1e-3;
inline constexpr double k_mm_per_metre = 1e3;
inline constexpr double k_mm_per_inch = 25.4;
inline constexpr double k_radians_per_degree = std::numbers::pi / 180;
inline constexpr double k_degrees_per_radian = 180 / std::numbers::pi;

}  // namespace papilla
