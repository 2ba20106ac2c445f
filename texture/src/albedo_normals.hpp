// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/core/vec.hpp"
#include "photograph_gains.hpp"

namespace papilla::texture_detail {

/// albedo · normal at every pixel.
using NormalField = std::vector<Vec3>;

/// Least squares over all photographs, pixel by pixel. @pre the lights have rank 3.
NormalField normals_of(const Photographs& photographs, const std::vector<Vec3>& lights);

/// What a photograph shows at a pixel.
enum class Seen : std::uint8_t { surface, shadow, highlight };

struct RobustNormals {
  NormalField normals;
  std::vector<float> confidence;                         ///< In [0, 1].
  double shadows_fraction = 0, highlights_fraction = 0;  ///< Of all pixels of all photographs.
};

/// normals_of() without shadows and highlights. With four photographs or more one of them is left out at a pixel where
/// the others agree better without it, by more than `deviation` explains, and it is dark there as a shadow, or brighter
/// than the others say and seen near the mirror direction. The confidence falls with what the photographs disagree,
/// with one that is left out and with shadows in those that stay.
RobustNormals robust_normals(const Photographs& photographs, const std::vector<Vec3>& lights, double deviation);

/// −b_x/b_z and −b_y/b_z, at most k_steepest_slope long.
Slopes slopes_of(const NormalField& normals);
inline constexpr double k_steepest_slope = 4;

}  // namespace papilla::texture_detail
