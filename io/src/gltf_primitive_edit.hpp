// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "gltf_file.hpp"
#include "gltf_material_edit.hpp"
#include "papilla/io/gltf_edit.hpp"

namespace papilla {

/// What the file that is edited was read as.
struct GltfSource {
  const std::filesystem::path& path;
  const Scene& scene;
  const GltfOrigin& origin;
};

/// Gives the primitives that show the materials their new uv and tangents.
/// @param notes  gets the extensions of primitives that may not fit any more.
/// @throws IoError, InvalidInput as GltfVertexReader.
void edit_primitives(GltfFile& file, const GltfSource& source, const WantedEdits& wanted,
                     const std::vector<EditedMaterial>& materials, std::vector<std::string>& notes);

}  // namespace papilla
