// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "papilla/io/scene.hpp"

namespace papilla {

/// A transform as translation · rotation · scale.
struct Trs {
  Vec3 translation;
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< Unit quaternion x, y, z, w.
  Vec3 scale{1, 1, 1};
};

/// Takes an affine map apart; a mirroring one gets a negative z scale. Empty when it shears by more than 1e-4 rad.
/// Rotation and scale are rounded to 2^-44 of their size.
std::optional<Trs> decompose(const Transform& transform);

}  // namespace papilla
