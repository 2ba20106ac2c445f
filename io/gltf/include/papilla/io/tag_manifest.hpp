// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "papilla/core/bounds.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// The members of extras that hold it: of the asset, and of nodes.
inline constexpr const char *k_tag_manifest = "hapticManifest", *k_node_tags = "hapticMaterials";

/// A second account of the haptic tags of a file, by which tags that other programs drop or merge are missed and found
/// again: asset.extras.hapticManifest, and in short extras.hapticMaterials of every node that shows a tagged material.
struct TagManifest {
  struct Entry {
    std::string name;  ///< Of the material.
    MaterialTag tag;   ///< In JSON without the bytes of its height map, which stay in the material.
  };
  /// The triangles of a part that show one material, as its first instance stands.
  struct Surface {
    std::string part, node;                 ///< Names.
    std::optional<std::uint32_t> material;  ///< Index into `materials`; none: it has no tag.
    double area_m2 = 0;
    std::optional<Bounds3> box_m;  ///< In the frame of the glTF file.
  };
  std::vector<Entry> materials;
  std::vector<Surface> surfaces;  ///< Of parts that show a tagged material.
};

/// The manifest of a scene: the tags of materials that something shows.
TagManifest tag_manifest(const Scene& scene);

/// The manifest as a JSON object: tags without data: URIs, lengths in steps of 1 µm. About 300 bytes a material and 150
/// a surface.
std::string to_json(const TagManifest& manifest);

/// Adds the manifest to the extras of the asset, and to those of the nodes the short form: name, area and constants of
/// each tagged material that the node shows. Extras that are no object stay as they are. Nothing without tags.
/// @param node_extras_json  one per node of the scene.
void add_tag_manifest(const Scene& scene, std::string& asset_extras_json, std::vector<std::string>& node_extras_json);

/// Moves the manifest out of asset extras, and the short forms out of the nodes' extras; these give the manifest where
/// the asset has none. Their other members stay. One that can't be read is none, with a sentence in Scene::warnings.
std::optional<TagManifest> take_tag_manifest(Scene& scene);

/// Finds the entries of `manifest` that no material has any more, and gives their tags back where that is unambiguous,
/// in this order:
/// 1. a material of the entry's name without tag gets it;
/// 2. the triangles of a part in one material without tag get it when all surfaces of the manifest whose area is the
/// same
///    within 2 % and whose part or node has the same name are of one entry ("part");
/// 3. the same with the box in place of the name: within 0.5 % of its diagonal ("place").
/// Materials are made for 2 and 3, named as the entry. A material that is not in the manifest, carries the tag of one
/// entry and has more than 1.05 times its area is the sum of several, as a palette makes it: its surfaces are looked
/// for as by 2 and 3, and those that are not found lose the tag, because it is another one's. The height map of a
/// restored tag is taken from a tag with the same SHA-256, else it is lost. Cost: one pass over the triangles, if
/// something is missing.
TagSurvival restore_tags(Scene& scene, const TagManifest& manifest);

/// Whether two tags feel the same, wherever their pictures are kept.
bool same_feel(MaterialTag a, MaterialTag b);

/// The URI of a picture that some haptic tag of the scene has, by its SHA-256; null when none does. Files hold each of
/// these pictures once, whatever the number of tags that name it.
const std::string* tag_picture(const Scene& scene, const std::string& sha256);

/// Gives every tag its own copy of the pictures that another one holds, so that tags can be dropped and changed.
void complete_tag_pictures(Scene& scene);

/// "7 of 20 haptic tags are lost …"; empty when none was missing.
std::string survival_sentence(const TagSurvival& tags);

}  // namespace papilla
