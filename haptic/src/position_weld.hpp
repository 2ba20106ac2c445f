// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla {

/// For each vertex the number of its position, from 0, the same for vertices that coincide bit for bit.
/// @param count becomes the number of positions. Cost: linear, 12 to 20 bytes a vertex.
std::vector<std::uint32_t> weld_positions(const std::vector<Vec3>& positions, std::size_t& count);

}  // namespace papilla
