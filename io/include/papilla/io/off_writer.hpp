// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Writes all instances of a scene as one ASCII [ST][C][N]OFF of triangles in millimetres and the scene's axes, node
/// transforms applied. Numbers are written so that reading gives the same doubles. Normals, colours (sRGB in [0, 1])
/// and texture coordinates are written when they have one value at every position. The same scene gives the same bytes;
/// a failure leaves the old file as it was.
/// @returns what OFF has no place for, one sentence each.
/// @throws InvalidInput when a number is not finite or an index is out of range; IoError when writing fails.
std::vector<std::string> write_off(const Scene& scene, const std::filesystem::path& path);

}  // namespace papilla
