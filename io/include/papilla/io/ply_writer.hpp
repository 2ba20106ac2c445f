// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Writes all instances of a scene as one binary little-endian PLY of triangles in millimetres and the scene's axes,
/// node transforms applied: 32-bit floats, colours as 8-bit sRGB. Positions stay shared: normals and colours are
/// written when they have one value at every position; texture coordinates then as s, t of the vertices, else as
/// MeshLab's texcoord of the faces. The same scene gives the same bytes; a failure leaves the old file as it was.
/// @returns what PLY has no place for, one sentence each.
/// @throws InvalidInput when a number is not finite as a 32-bit float or an index is out of range; IoError when writing
///         fails.
std::vector<std::string> write_ply(const Scene& scene, const std::filesystem::path& path);

}  // namespace papilla
