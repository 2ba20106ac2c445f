// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/read_options.hpp"

namespace papilla {

/// Whether a file is glTF by its extension, in any case: .glb, .gltf.
bool is_gltf_file(const std::filesystem::path& path);

/// Reads a file by its extension, in any case: .step .stp .p21 .iges .igs .brep .brp, .stl, .obj,
/// .ply, .off, .glb, .gltf, .fbx, .3mf, .dae, .ac, .x3d, .blend.
/// CAD surfaces are tessellated; faces that could not be are named in Scene::losses.
/// @throws IoError when the file can't be read; InvalidInput when the extension is unknown (the message lists
///         the known ones) or the content is not what the extension says.
Scene read_scene(const std::filesystem::path& path, const ReadOptions& options = {},
                 const ProgressCallback& progress = {});

using WriteOptions = GlbWriteOptions;  ///< Other formats have none.

/// Writes a file by its extension, in any case: .glb, .gltf, .obj, .off, .ply, .stl.
/// @param sizes  when given and the file is glTF, gets what its data take.
/// @returns what the format has no place for, one sentence each (Scene::losses are not repeated).
/// @throws InvalidInput when the extension is unknown or the scene can't be written so; IoError when writing fails.
std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& path,
                                     const WriteOptions& options = {}, GlbSizes* sizes = nullptr);

}  // namespace papilla
