// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "papilla/pipeline/studio/studio_scene.hpp"

namespace papilla {

/// Of a surface that was made; null: it has none.
inline const Material* material_of(const StudioSurface& surface) {
  return surface.look && !surface.look->materials.empty() ? &surface.look->materials.front() : nullptr;
}

inline bool is_felt(const StudioSurface& surface) {
  const Material* material = material_of(surface);
  return material != nullptr && material->haptic.has_value();
}

/// Lets a material name the pictures of another scene, which are taken along.
class TakenPictures {
 public:
  TakenPictures(const Scene& from, Scene& to) : from_(from), to_(to) {}

  void take_all(Material& material) {
    for (auto* reference : {&material.base_color_texture, &material.metallic_roughness_texture,
                            &material.normal_texture, &material.occlusion_texture, &material.emissive_texture})
      take(*reference);
  }

 private:
  void take(std::optional<TextureReference>& reference) {
    if (!reference) return;
    const auto [place, is_new] = textures_.try_emplace(reference->texture, to_.textures.size());
    if (is_new) {
      Texture texture = from_.textures.at(reference->texture);
      if (texture.image) texture.image = image(*texture.image);
      for (OtherImage& other : texture.others) other.image = image(other.image);
      to_.textures.push_back(std::move(texture));
    }
    reference->texture = static_cast<std::uint32_t>(place->second);
  }

  std::uint32_t image(std::uint32_t number) {
    const auto [place, is_new] = images_.try_emplace(number, to_.images.size());
    if (is_new) to_.images.push_back(from_.images.at(number));
    return static_cast<std::uint32_t>(place->second);
  }

  const Scene& from_;
  Scene& to_;
  std::map<std::uint32_t, std::size_t> textures_, images_;
};

}  // namespace papilla
