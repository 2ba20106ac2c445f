// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/page_material.hpp"

#include <set>
#include <string>

#include "papilla/haptic/material_tag.hpp"

namespace papilla::app {
namespace {

Json pair(Vec2 v) { return {v.x, v.y}; }

}  // namespace

bool is_shown_by_browsers(const EncodedImage& image) {
  static const std::set<std::string> types = {"image/png",  "image/jpeg", "image/webp",
                                              "image/avif", "image/gif",  "image/bmp"};
  return types.contains(image.mime_type) && !image.bytes.empty();
}

Json texture_json(const Scene& scene, const std::optional<TextureReference>& reference) {
  if (!reference || reference->texture >= scene.textures.size() || reference->tex_coord > 1) return nullptr;
  const Texture& texture = scene.textures[reference->texture];
  if (!texture.image || *texture.image >= scene.images.size()) return nullptr;
  if (!is_shown_by_browsers(scene.images[*texture.image])) return nullptr;
  const UvTransform transform = reference->transform.value_or(UvTransform{});
  return {{"image", *texture.image},          {"tex_coord", reference->tex_coord},
          {"factor", reference->factor},      {"wrap", {texture.wrap_s, texture.wrap_t}},
          {"offset", pair(transform.offset)}, {"rotation", transform.rotation},
          {"scale", pair(transform.scale)}};
}

Json tag_json(MaterialTag tag) {
  for (PlacedPicture* picture : pictures_of(tag)) picture->uri.clear();
  return Json::parse(to_json(tag));
}

Json look_json(const Scene& scene, const Material& material) {
  return {{"name", material.name},
          {"color", material.base_color},
          {"metallic", material.metallic},
          {"roughness", material.roughness},
          {"emissive", material.emissive},
          {"double_sided", material.double_sided},
          {"alpha_mode", material.alpha_mode},
          {"alpha_cutoff", material.alpha_cutoff},
          {"base_map", texture_json(scene, material.base_color_texture)},
          {"normal_map", texture_json(scene, material.normal_texture)},
          {"shine_map", texture_json(scene, material.metallic_roughness_texture)}};
}

}  // namespace papilla::app
