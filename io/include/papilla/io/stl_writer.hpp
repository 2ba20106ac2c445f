// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Writes all instances of a scene as one binary STL in millimetres and the scene's axes, node transforms applied
/// (mirrored instances keep their outside), facet normals from the corners. Binary STL knows no parts: all become one
/// surface, and where two parts touch in whole edges, these have more than two triangles; write a format with parts to
/// keep them apart. Names, materials, colours and uv have no place either. The same scene gives the same bytes; a
/// failure leaves the old file as it was.
/// @returns what has no place in STL, one sentence each.
/// @throws InvalidInput when a position is not finite as a 32-bit float or there are more than 2^32 − 1 triangles;
///         IoError when writing fails.
std::vector<std::string> write_stl(const Scene& scene, const std::filesystem::path& path);

}  // namespace papilla
