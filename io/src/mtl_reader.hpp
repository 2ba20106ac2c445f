// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Adds the materials of an MTL file, with textures and encoded pictures, to a scene. Kd and d become the base colour,
/// Pr or else Ns the roughness (1 − sqrt(Ns / 1000)), Pm the metalness, Ke the emission, map_Kd the base colour
/// texture, norm, and map_Bump when it shows a normal map, the normal texture. Pictures are those of ScenePictures;
/// what glTF has no place for is a loss.
/// @throws IoError when the file can't be read; InvalidInput naming file and line.
void read_mtl(const std::filesystem::path& path, Scene& scene);

}  // namespace papilla
