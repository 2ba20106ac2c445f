// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Reads a .glb or .gltf file: meshes, node tree, materials, textures, images (kept encoded), extras.
/// Metres become millimetres; triangles, strips and fans become triangles; sparse accessors and
/// node transforms are honoured. Skins, morph targets, animations and cameras are listed in `losses`.
/// Links no library but tinygltf, so that the player can use it.
/// Cost: one pass over the file, about 200 bytes per triangle.
/// @throws IoError when the file can't be opened; InvalidInput naming file, place and reason when it is no
///         valid glTF, truncated, or needs an extension that is not supported.
Scene read_gltf(const std::filesystem::path& path);

}  // namespace papilla
