// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/io/gltf_origin.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

struct GltfReadOptions {
  /// A glTF file with the tags as they were, whose tags replace the list within the file; empty: that list is used.
  std::filesystem::path tags = {};
  /// Channel 1 is, where the haptic tag of a material names a channel above 1, that one: tag and pictures on it say 1,
  /// and pictures on channel 1 the other's number. For those who show or touch and do not write.
  bool tag_channel = false;
  /// The parts of coarser levels of detail stay, without nodes that show them. One below a node that shows a single
  /// part gets that part's name, so that rules for one hold for the other. For those who edit the file.
  bool coarser_parts = false;
  /// The vertex attribute _CAD_UV becomes TriangleMesh::cad_uv; triangles whose corners have one value have none.
  bool cad_uv = false;
};

/// Reads a .glb or .gltf file: meshes, node tree, materials, textures, images (kept encoded), extras.
/// Metres become millimetres, v becomes 1 − v; triangles, strips and fans become triangles; sparse accessors and
/// node transforms are honoured, so are compressed meshes (KHR_draco_mesh_compression with bitstream 2.2,
/// EXT_meshopt_compression; refused by name when the build was made without libdraco or libmeshoptimizer) and
/// instances (EXT_mesh_gpu_instancing; each becomes a child node). One part per glTF mesh, in the same order, with its
/// primitives' materials as slots; positions of whole numbers take over the scale of the first node that shows them;
/// positions equal in every bit are merged within a part, so that uv seams do not tear the surface. Skins, morph
/// targets, animations, cameras, lights, points, lines and coarser levels of detail (MSFT_lod: the finest is read) are
/// listed in `losses`; pictures that are missing in `warnings`. Haptic tags that other programs dropped or merged are
/// looked for by restore_tags(); `Scene::tags` says what came of it. Links no heavy library, so that the player can use
/// it.
///
/// Pictures stay encoded, so that those in WebP, AVIF, KTX2 or DDS stop nothing. A required extension that is unknown
/// is refused where it may touch geometry: it stands at meshes, nodes, accessors or buffers, or nowhere. One that only
/// stands at materials, textures, pictures, cameras, animations or the root is a warning.
///
/// Guarantees: finite numbers, indices in range, a forest of nodes, whatever the file says. Every count is checked
/// against the bytes present before memory is allocated for it; the elements of all uses of all accessors together are
/// limited to 64 per byte of the buffers plus 2^20, and to 2^28. Cost: one pass over the file, about 200 bytes per
/// triangle. Deterministic.
/// @throws IoError when the file can't be read; InvalidInput naming file, place and reason when it is no
///         valid glTF 2, truncated, or needs an extension that is not supported; or when the file of the options has
///         no haptic tag.
/// @param origin  when given, gets where parts and nodes stand in the file.
Scene read_gltf(const std::filesystem::path& path, const GltfReadOptions& options = {}, GltfOrigin* origin = nullptr);

}  // namespace papilla
