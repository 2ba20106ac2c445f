// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

struct GlbWriteOptions {
  double crease_deg = 40;  ///< Parts without normals are shaded smoothly over edges up to this angle.
  /// Draft extensions of others that repeat the content of the haptic tags as far as they can hold it. The tags remain
  /// and take precedence: tools drop an extension that they do not know.
  bool mirror_mpeg_haptics = false;  ///< MPEG_material_haptic: height maps as vibrotactile textures of whole meshes.
  bool mirror_khr_physics = false;   ///< KHR_physics_rigid_bodies: friction as physics materials of colliders.
  bool cad_uv = true;  ///< CAD (u,v) as the vertex attribute _CAD_UV: it splits vertices between CAD faces.
};

/// Writes a scene as one .glb file: millimetres become metres, v becomes 1 − v, and a root node turns Z up to Y up.
///
/// Nodes, names, extras, material extensions and encoded pictures are written as they are; a part that
/// several nodes use is stored once; parts without an instance are left out. Levels of detail become nodes of their own
/// that no scene names, as the vendor extension MSFT_lod has it: the node that shows the part lists them, and its
/// extras hold one MSFT_screencoverage a level, the last 0; a node with children gets one more child to that end.
/// Corners that agree in all attributes (after rounding to 32-bit floats) share a vertex. Materials with a normal
/// texture get tangents. `asset.extras` states the source's format and unit. CAD (u,v) become 32-bit floats in
/// _CAD_UV, 0 where a triangle of a primitive with them has none. Face numbers, references to
/// missing pictures and to texture channels above 1 have no place in glTF and are left out. The file has no errors or
/// warnings in the Khronos validator, the same scene gives the same bytes, and a failure leaves the old file as it was.
/// @returns what has no place in glTF, one sentence each.
/// @throws InvalidInput naming the part, node or material: a number is not finite, an index is out of range, a node's
///         transform shears, coverages of levels do not descend within [0, 1], JSON can't be parsed, or the result
///         exceeds 4 GiB. IoError when writing fails.
std::vector<std::string> write_glb(const Scene& scene, const std::filesystem::path& path,
                                   const GlbWriteOptions& options = {});

/// The same as a .gltf file with its binary data and pictures in files beside it, named after it: dash.gltf, dash.bin,
/// dash-leather.png. Takes twice the memory of the binary data. The files are replaced one by one, the .gltf last: a
/// failure in between leaves the new ones of some.
/// @throws IoError, too, when a file beside it exists with other content and the former .gltf of that name did not name
///         it: it may belong to another scene.
std::vector<std::string> write_gltf(const Scene& scene, const std::filesystem::path& path,
                                    const GlbWriteOptions& options = {});

}  // namespace papilla
