// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gltf_side_files.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// A bufferView as it is before EXT_meshopt_compression, and how it is compressed.
struct MeshoptLayout {
  std::size_t count = 0, stride = 0;
  const char *mode = "", *filter = "NONE";
};

/// The binary data of a glTF file under construction, with its bufferViews and accessors. The bytes are not copied
/// until write() writes them, one view after the other.
class GlbBuffer {
 public:
  using Json = nlohmann::ordered_json;

  enum class Target { none = 0, vertices = 34962, indices = 34963 };

  /// @param largest_buffer  a view that would make a buffer larger starts the next one.
  explicit GlbBuffer(std::size_t largest_buffer) : largest_buffer_(largest_buffer) {}

  /// Adds bytes that outlive the buffer, aligned to 4, and returns the number of their bufferView.
  /// @param stride  of the vertices; 0: they lie without gaps.
  /// @throws InvalidInput when the bytes alone are more than a buffer may hold.
  std::size_t add_view(std::span<const std::byte> bytes, Target target, std::size_t stride = 0);

  /// The same with values that the buffer keeps.
  template <class T>
  std::size_t add_view(std::vector<T>&& values, Target target, std::size_t stride = 0) {
    return add_view(keep(std::move(values)), target, stride);
  }

  /// A view whose bytes are a stream of meshopt.
  std::size_t add_meshopt_view(std::vector<unsigned char>&& stream, Target target, const MeshoptLayout& layout);

  /// Appends an accessor over a whole bufferView and returns its number. `accessor` holds its other properties.
  std::size_t add_accessor(std::size_t view, Json accessor);

  /// An accessor whose values an extension has.
  std::size_t add_accessor(Json accessor);

  /// Counts what a primitive takes, and what it would take without compression.
  void count_mesh(std::size_t bytes, std::size_t uncompressed) noexcept {
    mesh_bytes_ += bytes;
    uncompressed_mesh_bytes_ += uncompressed;
  }
  std::size_t mesh_bytes() const noexcept { return mesh_bytes_; }
  std::size_t uncompressed_mesh_bytes() const noexcept { return uncompressed_mesh_bytes_; }

  /// Bytes of each buffer.
  const std::vector<std::size_t>& sizes() const noexcept { return sizes_; }

  /// Adds "buffers", "bufferViews" and "accessors", as far as there are any, to a document.
  void describe(Json& gltf) const;

  /// All bytes of a buffer, sizes()[number] of them.
  void write(std::size_t number, std::ostream& out) const;

 private:
  struct Content {
    std::size_t buffer = 0, offset = 0;
    std::span<const std::byte> bytes;
  };

  template <class T>
  std::span<const std::byte> keep(std::vector<T>&& values) {
    auto owned = std::make_shared<const std::vector<T>>(std::move(values));
    const auto bytes = std::as_bytes(std::span(*owned));
    owners_.push_back(std::move(owned));
    return bytes;
  }
  const Content& add_content(std::span<const std::byte> bytes);

  std::size_t largest_buffer_;
  std::vector<Content> contents_;
  std::vector<std::shared_ptr<const void>> owners_;
  std::vector<std::size_t> sizes_;
  std::size_t fallback_size_ = 0;  ///< Of the buffer without data that compressed views name.
  std::size_t mesh_bytes_ = 0, uncompressed_mesh_bytes_ = 0;
  Json views_ = Json::array(), accessors_ = Json::array();
};

/// The length of the container of glTF 2.0, 4.4: header, chunks and their padding.
/// @throws InvalidInput, which names the file and a way out, when it does not fit into 32 bits.
std::size_t glb_length(const std::filesystem::path& path, std::size_t json_size, std::size_t binary_size,
                       std::size_t further_size);

/// Writes the container by write_atomically().
/// @param write_binary  writes `binary_size` bytes. @param further_chunks  whole ones, each with its header.
/// @throws InvalidInput as glb_length(); as write_atomically().
void write_glb_container(const std::filesystem::path& path, const std::string& json, std::size_t binary_size,
                         const std::function<void(std::ostream&)>& write_binary, std::string_view further_chunks = {});

/// The largest "texCoord" of any texture in a part of a document, −1 without any texture.
int largest_tex_coord(const GlbBuffer::Json& json);

/// KHR_texture_transform.
GlbBuffer::Json texture_transform_json(const UvTransform& transform);

/// The tag as JSON; its picture, which may be long, is not parsed.
GlbBuffer::Json haptic_json(const MaterialTag& tag);

/// Vertex attributes that a material needs of the meshes that use it.
struct MaterialNeeds {
  int tex_coords = 0;  ///< TEXCOORD_0 … that must be there.
  /// Of the finest picture on TEXCOORD_0 and TEXCOORD_1: texels along a unit of uv. 0: there is none.
  std::array<double, 2> texels_per_uv{};
  bool tangents = false;
  int tangent_tex_coord = 0;
};

/// Parses extras or extensions of a scene. `where` names their owner in messages.
/// @throws InvalidInput when the text is no JSON.
GlbBuffer::Json parse_scene_json(const std::string& text, const std::string& where);

/// Of haptic tags.
/// @param materials  of a document, here and below; null: none.
TagPictures tag_pictures_in(const GlbBuffer::Json& materials);

/// Lets tags hold each picture once: of those with the same bytes the first one has the data: URI, the others name it
/// by their SHA-256.
/// @param edited  numbers of the materials that may lose their copy; nothing: all.
/// @param known  data: URIs by SHA-256: a tag whose picture no other one holds any more gets it.
void share_tag_pictures(GlbBuffer::Json& materials, const std::optional<std::set<std::size_t>>& edited = std::nullopt,
                        const std::map<std::string, std::string>& known = {});

/// The data: URIs of all of them by SHA-256.
std::map<std::string, std::string> held_tag_pictures(const GlbBuffer::Json& materials);

/// The data: URI of a tag's picture, whichever tag holds it; null: none does.
/// @param picture  "height" or "maps" of a tag.
const std::string* tag_picture_uri(const GlbBuffer::Json& materials, const GlbBuffer::Json& picture);

/// A picture that becomes WebP or JPEG: a PNG or JPEG that gets smaller by it and keeps its alpha.
/// @param quality  1 to 100. @returns nothing when it stays as it is.
/// @param name  of the picture in messages. @throws InvalidInput when it is damaged.
std::optional<EncodedImage> recoded_picture(const EncodedImage& image, PictureCoding coding, int quality,
                                            const std::string& name);

/// Writes images, samplers, textures and materials of a scene into a glTF document.
class MaterialWriter {
 public:
  /// @param files  gets the pictures; null: the buffer does.
  MaterialWriter(const Scene& scene, const GlbWriteOptions& options, GlbBuffer& buffer, GltfSideFiles* files)
      : scene_(scene), options_(options), buffer_(buffer), files_(files) {}

  void write(GlbBuffer::Json& gltf);

  /// One per material, after write().
  const std::vector<MaterialNeeds>& needs() const noexcept { return needs_; }

  /// Extensions without which a texture has no picture.
  const std::set<std::string>& required() const noexcept { return required_; }

  std::size_t picture_bytes() const noexcept { return picture_bytes_; }
  std::size_t uncompressed_picture_bytes() const noexcept { return uncompressed_picture_bytes_; }

 private:
  using Json = GlbBuffer::Json;
  void recode_images();
  void write_images(Json& gltf);
  void note_texels(int tex_coord, const std::optional<UvTransform>& transform, int longest_side,
                   MaterialNeeds& needs) const;
  int longest_side(std::size_t image) const;
  void write_textures(Json& gltf);
  void write_sources(const Texture& texture, Json& json);
  Json material(std::size_t number);
  bool is_usable(const TextureReference& reference) const;
  Json reference(const TextureReference& reference, const char* factor_name, MaterialNeeds& needs) const;

  const Scene& scene_;
  const GlbWriteOptions& options_;
  GlbBuffer& buffer_;
  GltfSideFiles* files_;
  std::map<std::size_t, EncodedImage> recoded_;  ///< By the number of the image.
  std::vector<std::optional<std::size_t>> image_number_;
  mutable std::map<std::size_t, int> longest_side_;  ///< Of images, in pixels.
  std::size_t picture_bytes_ = 0, uncompressed_picture_bytes_ = 0;
  std::vector<MaterialNeeds> needs_;
  std::set<std::string> required_;
};

/// How the whole numbers that stand for positions become millimetres: p = scale · 1000 q + offset_mm.
struct Dequantization {
  double scale = 1;
  Vec3 offset_mm;
};

struct GlbMesh {
  GlbBuffer::Json json;  ///< Null when the part has no triangles.
  /// What the nodes that show it have to do to its positions; nothing: they are metres.
  std::optional<Dequantization> positions;
};

/// The vertices and triangles of a part's glTF mesh: one primitive per material slot that has triangles.
struct GlbPrimitives;

/// Most of the work, which needs no buffer: parts may be worked on at once.
std::shared_ptr<GlbPrimitives> glb_primitives(const Part& part, const std::vector<MaterialNeeds>& materials,
                                              const GlbWriteOptions& options);

/// The glTF mesh of a part.
/// @param primitives  of the part; taken.
GlbMesh glb_mesh(const Part& part, std::shared_ptr<GlbPrimitives> primitives, MeshCoding coding, GlbBuffer& buffer);

/// Repeats the height maps of haptic tags as MPEG_material_haptic (ISO/IEC DIS 23090-14, second edition; a draft): a
/// material at the root for each tag with a map, its vibrotactileTexture of type High_Resolution with the map's scale
/// and offset in extras, and hapticMaterialIndex on each mesh that has a single material. The draft holds textures
/// only: constants stay in the tags.
/// @param gltf with materials, meshes and nodes. @param buffer gets the pictures of the maps, each once.
/// @returns what has no place, one sentence each.
std::vector<std::string> mirror_mpeg_haptics(GlbBuffer::Json& gltf, GlbBuffer& buffer);

/// Repeats static and dynamic friction of haptic tags as KHR_physics_rigid_bodies (a draft): a physics material at the
/// root for each tag, and a collider of the node's own mesh on each node whose mesh has a single tagged material.
/// Levels of detail are no colliders.
/// @param not_mirrored gets what has no place, one sentence each.
void mirror_khr_physics(GlbBuffer::Json& gltf, std::vector<std::string>& not_mirrored);

}  // namespace papilla
