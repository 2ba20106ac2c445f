// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <iosfwd>
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

/// The binary chunk of a GLB under construction, with its bufferViews and accessors. The bytes are not copied
/// until write() writes them, one view after the other.
class GlbBuffer {
 public:
  using Json = nlohmann::ordered_json;

  enum class Target { none = 0, vertices = 34962, indices = 34963 };

  /// Adds bytes that outlive the buffer, aligned to 4, and returns the number of their bufferView.
  std::size_t add_view(std::span<const std::byte> bytes, Target target);

  /// The same with values that the buffer keeps.
  template <class T>
  std::size_t add_view(std::vector<T>&& values, Target target) {
    auto owned = std::make_shared<const std::vector<T>>(std::move(values));
    const auto bytes = std::as_bytes(std::span(*owned));
    owners_.push_back(std::move(owned));
    return add_view(bytes, target);
  }

  /// Appends an accessor over a whole bufferView and returns its number. `accessor` holds its other properties.
  std::size_t add_accessor(std::size_t view, Json accessor);

  std::size_t size() const noexcept { return size_; }
  const Json& views() const noexcept { return views_; }
  const Json& accessors() const noexcept { return accessors_; }

  /// All bytes, size() in number.
  void write(std::ostream& out) const;

 private:
  std::vector<std::span<const std::byte>> contents_;
  std::vector<std::shared_ptr<const void>> owners_;
  std::size_t size_ = 0;
  Json views_ = Json::array(), accessors_ = Json::array();
};

/// Writes the container of glTF 2.0, 4.4, by write_atomically().
/// @param write_binary  writes `binary_size` bytes. @param further_chunks  whole ones, each with its header.
/// @throws InvalidInput when it exceeds 4 GiB; as write_atomically().
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
  bool tangents = false;
  int tangent_tex_coord = 0;
};

/// Parses extras or extensions of a scene. `where` names their owner in messages.
/// @throws InvalidInput when the text is no JSON.
GlbBuffer::Json parse_scene_json(const std::string& text, const std::string& where);

/// Writes images, samplers, textures and materials of a scene into a glTF document.
class MaterialWriter {
 public:
  /// @param files  gets the pictures; null: the buffer does.
  MaterialWriter(const Scene& scene, GlbBuffer& buffer, GltfSideFiles* files)
      : scene_(scene), buffer_(buffer), files_(files) {}

  void write(GlbBuffer::Json& gltf);

  /// One per material, after write().
  const std::vector<MaterialNeeds>& needs() const noexcept { return needs_; }

  /// Extensions without which a texture has no picture.
  const std::set<std::string>& required() const noexcept { return required_; }

 private:
  using Json = GlbBuffer::Json;
  void write_images(Json& gltf);
  void write_textures(Json& gltf);
  void write_sources(const Texture& texture, Json& json);
  Json material(std::size_t number);
  bool is_usable(const TextureReference& reference) const;
  Json reference(const TextureReference& reference, const char* factor_name, MaterialNeeds& needs) const;

  const Scene& scene_;
  GlbBuffer& buffer_;
  GltfSideFiles* files_;
  std::vector<std::optional<std::size_t>> image_number_;
  std::vector<MaterialNeeds> needs_;
  std::set<std::string> required_;
};

/// The glTF mesh of a part: one primitive per material slot that has triangles. Null when the part has no triangles.
GlbBuffer::Json glb_mesh(const Part& part, const std::vector<MaterialNeeds>& materials, const GlbWriteOptions& options,
                         GlbBuffer& buffer);

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
