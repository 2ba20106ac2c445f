// SPDX-License-Identifier: MIT
#include "weather/felt_relief.hpp"

#include <cmath>

#include "papilla/core/base64.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/roughness.hpp"

namespace papilla {
HeightTag height_tag_of(const HeightMap& relief) {
  const EncodedHeight encoded = encode_height_png16(relief);
  HeightTag height;
  height.uri = "data:image/png;base64," + encode_base64(encoded.png);
  height.sha256 = sha256_hex(encoded.png);
  height.size = {relief.width, relief.height};
  height.scale_m = k_metres_per_mm * encoded.scale_mm, height.offset_m = k_metres_per_mm * encoded.offset_mm;
  height.metres_per_uv = {k_metres_per_mm * relief.pitch_mm_x * relief.width,
                          k_metres_per_mm * relief.pitch_mm_y * relief.height};
  height.rms_m = k_metres_per_mm * rms_height_mm(relief);
  return height;
}

void assign_relief(Material& material, HeightTag height) {
  std::vector<HapticWarning> warnings;
  std::optional<MaterialTag> tag = material_tag_of_extras(material.extras_json, warnings);
  if (!tag) return;
  if (const auto& place = material.normal_texture) {
    height.tex_coord = place->tex_coord;
    if (place->transform) {
      height.uv_transform = {place->transform->offset, place->transform->rotation, place->transform->scale};
      // Before the transform; a repeat is 1 / scale of the uv.
      height.metres_per_uv = {height.metres_per_uv.x * std::abs(place->transform->scale.x),
                              height.metres_per_uv.y * std::abs(place->transform->scale.y)};
    }
  }
  if (tag->roughness) tag->roughness->rms_height_m = height.rms_m;
  tag->height = std::move(height);
  material.extras_json = with_material_tag(material.extras_json, *tag);
}

}  // namespace papilla
