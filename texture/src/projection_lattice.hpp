// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla::texture_detail {

/// Two vectors that span the lattice of a cloud of points, by Davis' and Peinecke's method: the two directions along
/// which the projected points are most concentrated, (1/n²) Σ_ij exp(−λ |a_i − a_j|), λ = 0.5 per pixel, and along each
/// of them the most frequent distance of the points projected along the other one, every distance counted as a normal
/// distribution of 1.5 pixels. Nothing for fewer than three points or when no distance exceeds 4 pixels.
/// Davis, 1979 (polarograms); Schulze 2005, section 7.2.2.
std::optional<std::array<Vec2, 2>> projection_lattice(const std::vector<Vec2>& points);

}  // namespace papilla::texture_detail
