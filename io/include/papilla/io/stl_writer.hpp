// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Writes all instances of a scene as one binary STL in millimetres and the scene's axes, node transforms applied
/// (mirrored instances keep their outside), facet normals from the corners. Names, materials and uv have no place in
/// STL. The same scene gives the same bytes; a failure leaves the old file as it was.
/// @throws InvalidInput when a position is not finite as a 32-bit float or there are more than 2^32 − 1 triangles;
///         IoError when writing fails.
void write_stl(const Scene& scene, const std::filesystem::path& path);

}  // namespace papilla
