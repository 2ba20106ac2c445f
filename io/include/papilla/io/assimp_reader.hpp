// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/core/progress.hpp"
#include "papilla/io/read_options.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// Reads FBX (binary and ASCII, from 7.1), 3MF, COLLADA, AC3D, X3D (XML) and Blender files by the library assimp, as
/// far as it understands them: docs/files.md lists what it does not.
///
/// The tree of nodes stays, without the root that assimp adds; nodes that hold the same meshes share a Part, with a
/// slot for each material. Positions equal in every bit are merged; polygons of any shape are cut into triangles. Unit
/// and upward axis are the file's (FBX UnitScaleFactor and UpAxis, COLLADA unit and up_axis, 3MF unit); X3D counts in
/// metres, Blender in metres by default (assumed), AC3D states none. Vertex colours and 3MF's display colours are sRGB.
/// Pictures are embedded ones (PNG, JPEG) or files beside or below the file.
/// Every kind of thing that is left behind is one sentence of `losses`, with its number where that is known.
///
/// assimp runs in a child process (run_isolated()), gets the file's bytes and can open nothing else. Numbers are those
/// of 32-bit floats. Deterministic.
/// @throws IoError when the file can't be read; InvalidInput naming the file and the reason when it is damaged, of
///         another kind, holds no triangle, makes the library crash, hang or take more memory than 1 GiB and 300 times
///         its size, or has nodes below more than 1024 others.
Scene read_assimp(const std::filesystem::path& path, const ReadOptions& options = {},
                  const ProgressCallback& progress = {});

/// True for the extensions that read_assimp() reads, in any case: .fbx .3mf .dae .ac .x3d .blend.
bool is_assimp_extension(const std::filesystem::path& path);

}  // namespace papilla
