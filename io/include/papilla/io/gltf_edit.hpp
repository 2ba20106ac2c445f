// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "papilla/io/glb_writer.hpp"
#include "papilla/io/gltf_origin.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// What becomes of the triangles of a part that have one slot of its materials.
struct GltfSurfaceEdit {
  std::uint32_t part = 0, slot = 0;  ///< Of the scene.
  std::string rule;                  ///< What its material is made by, for extras.papilla; may be empty.
  std::optional<MaterialTag> tag;    ///< Of its material; nothing: it has none.
  std::optional<std::array<double, 4>> base_color;
  std::optional<double> roughness, metallic;
  std::string environment_json;  ///< For extras.papilla.environment, with a rule; empty: it has none.
  /// Pictures of a grain, of which a material takes those for whose use it has none of its own. They outlive the call.
  const EncodedImage *normal_map = nullptr, *picture = nullptr, *shine = nullptr;
  /// Factors of `shine`, metallic-roughness, or without it: what goes with `picture` where that is taken.
  std::optional<double> picture_roughness, picture_metallic;
  std::optional<UvTransform> transform;  ///< Of the pictures, when the surface keeps its uv.
  /// New uv, per triangle in the part's order: they become one more channel, of the pictures and the tag. Empty: those
  /// are on channel 0.
  CornerAttribute<Vec2> uv;
  /// Per triangle, 1: the scene and the origin have its corners in the opposite order to the file's. It is written so,
  /// with the normals of its corners negated. Empty: none.
  std::vector<std::uint8_t> turned;
  bool double_sided = false;    ///< Its material becomes so.
  bool keeps_material = false;  ///< Nothing but `turned` counts.
};

/// A difference between the file read and the file written.
struct GltfChange {
  std::string kind;     ///< "added", "changed", "removed".
  std::string pointer;  ///< JSON pointer.
};

struct GltfEditResult {
  Scene scene;                      ///< With the materials' tags as written; its uv are those that were read.
  std::vector<GltfChange> changes;  ///< All of them, in the order of the document.
  std::vector<std::string> notes;   ///< What an edit could not do, one sentence each.
  TagPictures tag_pictures;
};

/// Writes a glTF file with new haptic tags and, where asked for, relief; all else stays as it is. No member of the
/// document changes that is not listed, every original bufferView keeps its bytes, new data follow behind.
///
/// Of parts that the origin says to be of one mesh the first keeps it. The others get copies, of the same name and on
/// the same data, which the nodes that show them name; animations of the mesh (KHR_animation_pointer) move them, too.
///
/// A tag goes into the material; of edited tags with the same height map one holds it, as by write_glb(), unless an
/// unedited one does. Where others show the material, too, or tags differ, a copy is appended and named by
/// the primitives, and by their variants (KHR_materials_variants); coarser materials (MSFT_lod) are tagged with theirs,
/// and animations of a material (KHR_animation_pointer) move its copies, too. New uv are one more TEXCOORD of the
/// primitives; where a vertex needs several, the attributes and morph targets of those that share its buffers are
/// written anew with the vertex repeated at the end, in their component types. Primitives that get a normal map get
/// TANGENT, too. Draco data that would have to change are written decoded. The list of tags (tag_manifest.hpp) is
/// brought up to date. The same input gives the same bytes.
/// @param source  what `scene` and `origin` were read from. @pre An entry of GltfOrigin::nodes shows one part.
/// @param output  .gltf: with binary data and new pictures in files beside it, named after it, and copies of the files
///         that the source names, at the same places below the output's folder. Any other name: one GLB.
/// @throws IoError, InvalidInput as read_gltf(); InvalidInput naming the material whose extras are no object, or the
///         primitive that has no free channel of texture coordinates; IoError when a file beside a .gltf would replace
///         one that the former .gltf of that name did not name.
GltfEditResult write_edited_gltf(const std::filesystem::path& source, Scene scene, const GltfOrigin& origin,
                                 std::vector<GltfSurfaceEdit> edits, const std::filesystem::path& output);

}  // namespace papilla
