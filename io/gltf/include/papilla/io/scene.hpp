// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "papilla/core/up_axis.hpp"
#include "papilla/core/uv_transform.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Row-major affine map of column vectors; translation in millimetres.
using Transform = std::array<double, 16>;
inline constexpr Transform k_identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// An encoded picture, byte for byte as in the file it came from.
struct EncodedImage {
  std::string name;
  std::string mime_type;  ///< "image/png", "image/jpeg"; of glTF also "image/webp", "image/avif", "image/ktx2".
  std::string uri;        ///< Where it came from, relative to the scene's file; empty when embedded.
  std::vector<std::byte> bytes;
  std::string extras_json;
};

/// The same picture in a format that a glTF extension brings, as EXT_texture_webp does.
struct OtherImage {
  std::string extension;
  std::uint32_t image = 0;  ///< Index into Scene::images.
};

/// How a texture is sampled; the numbers are glTF's (OpenGL's), 0 = not given.
struct Texture {
  std::optional<std::uint32_t> image;  ///< PNG or JPEG; the first of `others` where there is neither.
  std::vector<OtherImage> others;      ///< Those that are read by few programs last.
  std::string name;
  int wrap_s = 10497, wrap_t = 10497;  ///< 10497 repeat, 33071 clamp, 33648 mirrored repeat.
  int min_filter = 0, mag_filter = 0;
  std::string extras_json, extensions_json;
};

struct TextureReference {
  std::uint32_t texture = 0;  ///< Index into Scene::textures.
  int tex_coord = 0;
  double factor = 1;                     ///< normalTexture.scale or occlusionTexture.strength.
  std::optional<UvTransform> transform;  ///< transform_uv() applies it to a scene's uv.
};

struct Material {
  std::string name;
  std::array<double, 4> base_color{1, 1, 1, 1};  ///< Linear RGBA.
  double metallic = 0, roughness = 0.8;
  std::array<double, 3> emissive{0, 0, 0};
  bool double_sided = false;
  std::string alpha_mode = "OPAQUE";  ///< glTF: OPAQUE, MASK, BLEND.
  double alpha_cutoff = 0.5;
  std::optional<TextureReference> base_color_texture, metallic_roughness_texture, normal_texture, occlusion_texture,
      emissive_texture;
  std::optional<MaterialTag> haptic;           ///< extras.haptic: parsed by the reader, written by write_glb().
  std::vector<HapticWarning> haptic_warnings;  ///< Of its parsing.
  std::string extras_json;                     ///< The other extras: a JSON object, or empty.
  std::string
      extensions_json;  ///< glTF extensions as they were; texture numbers stay valid, textures are only appended.
};

/// A coarser stand-in for a part's mesh, with the same material slots.
struct PartLevel {
  TriangleMesh mesh;
  double screen_coverage = 0;  ///< Shown where the part's bounding sphere takes less of the picture's height than this.
};

/// One shape: a mesh and the materials its triangles name. Shared by all its instances: the nodes that name it. This is
/// the scene's only form of instancing, whatever a file's own one is.
struct Part {
  std::string name;
  std::string id;  ///< Stable over re-import: the assembly path of the first instance.
  TriangleMesh mesh;
  std::vector<std::uint32_t> materials;  ///< TriangleMesh::material slot -> Scene::materials.
  std::string extras_json;
  std::vector<PartLevel> levels;  ///< Ever coarser, coverage descending within [0, 1]; only write_glb() keeps them.
};

struct Node {
  std::string name;
  Transform local = k_identity;
  std::vector<std::uint32_t> children;
  std::optional<std::uint32_t> part;
  std::string extras_json;
};

/// Whose a file is and what wrote it; carried from input to output where the format has a place for it (glTF).
struct AssetInfo {
  std::string copyright;
  std::vector<std::string> generators;  ///< Programs that wrote the file, one after the other.
  std::string extras_json;              ///< Further statements, the licence among them: a JSON object, or empty.
  /// KHR_xmp_json_ld: the object of the root, and that of the asset, which names one of its packets. Or empty.
  std::string xmp_packets_json, xmp_reference_json;
};

/// A haptic tag that a file had when it was written and that no material has any more.
struct MissingTag {
  std::string material;     ///< That had it.
  std::string restored_by;  ///< "material name", "part" or "place"; empty: it is lost.
};

/// How the haptic tags got through what other programs did to the file, by the list that write_glb() adds.
struct TagSurvival {
  std::size_t expected = 0;  ///< Tags in the list; 0 without a list.
  std::vector<MissingTag> missing;
};

/// What a file holds, in millimetres, in the file's own axes.
///
/// Texture coordinates are those of OBJ for every format: u to the right, v up, (0, 0) at the lower left corner of the
/// picture, 1 = one repeat, so that an unmirrored chart has positive area. glTF's v runs down: its reader and
/// writer exchange v and 1 − v. The nodes form a forest: every node has at most one parent.
struct Scene {
  std::string format;       ///< "STEP", "STL", "OBJ", "glTF", ...
  std::string unit = "mm";  ///< The file's unit; `millimetres_per_unit` was applied when reading.
  double millimetres_per_unit = 1;
  UpAxis up = UpAxis::z;

  std::vector<Part> parts;
  std::vector<Node> nodes;
  std::vector<std::uint32_t> roots;  ///< Nodes without parent.
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<EncodedImage> images;

  std::string extras_json;
  AssetInfo asset;
  TagSurvival tags;
  std::vector<std::string> losses;    ///< What the reader had to leave behind, one sentence each.
  std::vector<std::string> warnings;  ///< What looked wrong and how it was read.
};

/// One use of a part: where it stands in the scene.
struct Instance {
  std::uint32_t part = 0;
  std::uint32_t node = 0;
  Transform world = k_identity;
};

/// a · b.
Transform multiply(const Transform& a, const Transform& b) noexcept;
Vec3 transform_point(const Transform& t, Vec3 p) noexcept;

/// Of the linear part: below 0 for one that mirrors.
double determinant(const Transform& t) noexcept;

/// Turns the scene's axes to glTF's Y up (the identity when it is Y up already): Z up becomes Y up, X stays.
Transform to_y_up(UpAxis up) noexcept;

/// All parts with their world transforms, depth first from the roots, children in their order. Nodes that can't be
/// reached from a root are left out. Cost: linear in the number of nodes; no recursion.
/// @throws InvalidInput when a node is reached twice (a cycle, or a node with two parents), a part or node
///         that does not exist is named, or the nodes are nested deeper than 1024 levels.
std::vector<Instance> instances(const Scene& scene);

/// Sets Part::id of every part to the names of the nodes above its first instance, joined by '/'. A node without
/// name counts as "#" and its number among its siblings; a second part of the same path gets "~2", and so on.
/// Parts without an instance get their own name.
/// @throws InvalidInput as instances().
void assign_part_ids(Scene& scene);

/// A scene of one part under one root node.
Scene single_part_scene(Part part, std::string format);

}  // namespace papilla
