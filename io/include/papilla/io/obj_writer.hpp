// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Writes all instances of a scene as OBJ in millimetres and the scene's axes, node transforms applied, one `o` an
/// instance, with texture channel 0 and normals where the mesh has them. When there are materials, a file of the same
/// name with .mtl, and beside it the base colour, emission and normal pictures, named after the OBJ file and the
/// picture. Numbers are written so that reading gives the same doubles. Vertex colours are written
/// behind the positions (sRGB) when they have one value at every position. Channel 1, extras and extensions have no
/// place. The same scene gives the same bytes; each file replaces its old one only when complete, the OBJ last.
/// @returns what has no place in OBJ, one sentence each.
/// @throws InvalidInput when a number is not finite or an index is out of range; IoError when writing fails.
std::vector<std::string> write_obj(const Scene& scene, const std::filesystem::path& path);

}  // namespace papilla
