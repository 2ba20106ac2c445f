// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Adds pictures to a scene as textures that are filtered linearly and by mip maps, each name once.
class SceneTextures {
 public:
  static constexpr int k_repeat = 10497, k_clamp_to_edge = 33071;  ///< glTF's numbers.

  /// @param scene  must outlive this. @param wrap  in both directions.
  explicit SceneTextures(Scene& scene, int wrap = k_repeat) : scene_(scene), wrap_(wrap) {}

  /// @return the texture's number in the scene: that of the first picture of this name.
  std::uint32_t add(const EncodedImage& image) {
    constexpr int k_linear = 9729, k_linear_mip_mapped = 9987;
    const auto [it, is_new] = known_.try_emplace(image.name, 0);
    if (!is_new) return it->second;
    scene_.images.push_back(image);
    Texture texture;
    texture.image = static_cast<std::uint32_t>(scene_.images.size() - 1);
    texture.name = image.name;
    texture.wrap_s = texture.wrap_t = wrap_;
    texture.min_filter = k_linear_mip_mapped, texture.mag_filter = k_linear;
    scene_.textures.push_back(std::move(texture));
    it->second = static_cast<std::uint32_t>(scene_.textures.size() - 1);
    return it->second;
  }

 private:
  Scene& scene_;
  int wrap_;
  std::map<std::string, std::uint32_t> known_;
};

}  // namespace papilla
