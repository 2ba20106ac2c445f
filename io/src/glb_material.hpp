// SPDX-License-Identifier: MIT
#pragma once

#include <set>

#include "glb_buffer.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// What a material asks of the meshes that wear it.
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
  MaterialWriter(const Scene& scene, GlbBuffer& buffer) : scene_(scene), buffer_(buffer) {}

  void write(GlbBuffer::Json& gltf);

  /// One per material, after write().
  const std::vector<MaterialNeeds>& needs() const noexcept { return needs_; }

 private:
  using Json = GlbBuffer::Json;
  void write_images(Json& gltf);
  void write_textures(Json& gltf);
  Json material(std::size_t number);
  bool is_usable(const TextureReference& reference) const;
  Json reference(const TextureReference& reference, const char* factor_name, MaterialNeeds& needs) const;

  const Scene& scene_;
  GlbBuffer& buffer_;
  std::vector<std::optional<std::size_t>> image_number_;
  std::vector<MaterialNeeds> needs_;
};

}  // namespace papilla
