// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include "papilla/io/scene.hpp"

namespace papilla::gltf {

/// Translation · rotation · scale.
/// @param rotation  a quaternion x, y, z, w of any length but zero.
/// @param where     begins messages.
/// @throws InvalidInput when the quaternion is zero.
Transform transform_from_trs(Vec3 translation, const std::array<double, 4>& rotation, Vec3 scale,
                             const std::string& where);

}  // namespace papilla::gltf
