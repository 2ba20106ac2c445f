// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// How meshes are stored. All but `none` round vertices first, to the same values whatever the codec, and put them into
/// an order of their own; then
/// - `meshopt` is EXT_meshopt_compression: positions and texture coordinates as fixed-point numbers by the filter
///   EXPONENTIAL, normals and tangents by OCTAHEDRAL;
/// - `draco` is KHR_draco_mesh_compression, edgebreaker;
/// - `quantize` is KHR_mesh_quantization alone: 16 bits a coordinate, which the nodes that show a mesh scale back.
enum class MeshCoding { none, meshopt, draco, quantize };

/// How pictures of materials are stored: as they are, or as WebP (EXT_texture_webp) or JPEG where that is smaller and
/// keeps their alpha.
enum class PictureCoding { as_is, webp, jpeg };

/// Whether this build can write it.
bool can_write(MeshCoding coding) noexcept;

/// What the pictures of haptic tags, height maps and maps, take in a file.
struct TagPictures {
  std::size_t uses = 0;    ///< By tags.
  std::size_t copies = 0;  ///< Held by the file as data: URIs.
  std::size_t bytes = 0;   ///< Of these.
};

/// What the data of a file take, in bytes.
struct GlbSizes {
  std::size_t meshes = 0, meshes_uncompressed = 0;      ///< The latter of the same vertices with MeshCoding::none.
  std::size_t pictures = 0, pictures_uncompressed = 0;  ///< The latter as they were in the scene.
  TagPictures tag_pictures;
};

struct GlbWriteOptions {
  double crease_deg = 40;  ///< Parts without normals are shaded smoothly over edges up to this angle.
  /// Draft extensions of others that repeat the content of the haptic tags as far as they can hold it. The tags remain
  /// and take precedence: tools drop an extension that they do not know.
  bool mirror_mpeg_haptics = false;  ///< MPEG_material_haptic: height maps as vibrotactile textures of whole meshes.
  bool mirror_khr_physics = false;   ///< KHR_physics_rigid_bodies: friction as physics materials of colliders.
  bool cad_uv = true;  ///< CAD (u,v) as the vertex attribute _CAD_UV: it splits vertices between CAD faces.
  MeshCoding meshes = MeshCoding::none;
  /// Farthest that rounding may move a vertex, in the part's own frame; 0: 1/16 384 of the part's longest side or
  /// 0.02 mm, whichever is less, but no less than 1/32 768 of the side. With `quantize` a part for which 16 bits are
  /// too few keeps its positions as floats.
  double most_rounding_mm = 0;
  PictureCoding pictures = PictureCoding::as_is;
  /// Bytes; write_gltf() starts another file of binary data where one would get larger.
  std::size_t largest_buffer = std::size_t{0xffffffff};
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
///
/// Haptic tags with the same height map, or picture of maps, share it: the first holds it, the others name it by its
/// SHA-256. No coding touches these pictures.
///
/// Rounding (MeshCoding): positions by at most `most_rounding_mm`; texture coordinates by at most 0.1 texel of the
/// finest picture that lies on them; normals and tangents to the 64 518 directions of an octahedron with 8 bits a
/// coordinate, by at most 0.7°; CAD (u,v) by 1/65 536 of their range in the part. Steps are powers of two, so that
/// floats hold the rounded values, and every codec gives them back bit for bit. Colours are kept.
/// @param sizes  when given, gets what the data take.
/// @returns what has no place in glTF, one sentence each.
/// @throws InvalidInput naming the part, node or material: a number is not finite, an index is out of range, a node's
///         transform shears, coverages of levels do not descend within [0, 1], JSON can't be parsed, the build
///         lacks the codec, or the result exceeds 4 GiB. IoError when writing fails.
std::vector<std::string> write_glb(const Scene& scene, const std::filesystem::path& path,
                                   const GlbWriteOptions& options = {}, GlbSizes* sizes = nullptr);

/// The same as a .gltf file with its binary data and pictures in files beside it, named after it: dash.gltf, dash.bin,
/// dash-leather.png. Data of more than `largest_buffer` bytes become several files: dash.bin, dash-2.bin. Takes twice
/// the memory of the binary data. The files are replaced one by one, the .gltf last: a failure in between leaves the
/// new ones of some.
/// @throws IoError, too, when a file beside it exists with other content and the former .gltf of that name did not name
///         it: it may belong to another scene.
std::vector<std::string> write_gltf(const Scene& scene, const std::filesystem::path& path,
                                    const GlbWriteOptions& options = {}, GlbSizes* sizes = nullptr);

}  // namespace papilla
