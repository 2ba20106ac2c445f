// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_surface.hpp"

#include <bit>
#include <cstring>

#include "json/json.hpp"
#include "json/scene_json.hpp"
#include "papilla/cache/digest.hpp"
#include "papilla/haptic/material_tag.hpp"

namespace papilla::app {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are sent as they are");

std::string short_name(const void* data, std::size_t size) {
  constexpr std::size_t k_digits = 16;
  return to_hex(sha256(data, size)).substr(0, k_digits);
}

Json pair(Vec2 v) { return {v.x, v.y}; }

/// Null where no browser shows the picture.
Json map_json(const Scene& look, const std::optional<TextureReference>& reference) {
  if (!reference || reference->tex_coord != 0) return nullptr;
  const Texture& texture = look.textures.at(reference->texture);
  if (!texture.image) return nullptr;
  const EncodedImage& image = look.images.at(*texture.image);
  if (image.bytes.empty()) return nullptr;
  const UvTransform transform = reference->transform.value_or(UvTransform{});
  return {{"image", *texture.image},          {"name", short_name(image.bytes.data(), image.bytes.size())},
          {"factor", reference->factor},      {"wrap", {texture.wrap_s, texture.wrap_t}},
          {"offset", pair(transform.offset)}, {"rotation", transform.rotation},
          {"scale", pair(transform.scale)}};
}

Json look_json(const Scene& look) {
  const Material material = look.materials.empty() ? Material{} : look.materials.front();
  Json json = {{"name", material.name},
               {"color", material.base_color},
               {"metallic", material.metallic},
               {"roughness", material.roughness},
               {"emissive", material.emissive},
               {"double_sided", material.double_sided},
               {"alpha_mode", material.alpha_mode},
               {"alpha_cutoff", material.alpha_cutoff},
               {"base_map", map_json(look, material.base_color_texture)},
               {"normal_map", map_json(look, material.normal_texture)},
               {"shine_map", map_json(look, material.metallic_roughness_texture)},
               {"haptic", nullptr}};
  if (material.haptic) json["haptic"] = {{"stiffness", material.haptic->stiffness}};
  return json;
}

class Arrays {
 public:
  template <class T>
  void add(const char* name, const std::vector<T>& values) {
    json[name] = {{"at", bytes.size()}, {"count", values.size()}};
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof(T) * values.size());
    if (!values.empty()) std::memcpy(bytes.data() + at, values.data(), sizeof(T) * values.size());
  }
  Json json = Json::object();
  std::string bytes;
};

}  // namespace

std::string short_name(const std::string& text) { return short_name(text.data(), text.size()); }

SharedText surface_bytes(const StudioSurface& surface) {
  const ShownMesh& mesh = surface.mesh;
  std::vector<float> uv = mesh.uv;
  for (std::size_t i = 1; i < uv.size(); i += 2) uv[i] = 1 - uv[i];
  Arrays arrays;
  arrays.add("positions", mesh.positions);
  arrays.add("normals", mesh.normals);
  arrays.add("uv", uv);
  arrays.add("measured", mesh.measured);
  arrays.add("seams", mesh.seams);
  arrays.add("indices", mesh.indices);
  Json json = {{"part", surface.part},
               {"slot", surface.slot},
               {"label", surface.label},
               {"look", look_json(*surface.look)},
               {"warnings", surface.warnings},
               {"seconds", surface.seconds},
               {"mm_per_uv", pair(surface.mm_per_uv)},
               {"report", nullptr}};
  if (!surface.report.method.empty())
    json["report"] = {{"method", surface.report.method}, {"reason", surface.report.reason},
                      {"charts", surface.report.charts}, {"seam_mm", surface.report.seam_mm},
                      {"notes", surface.report.notes},   {"distortion", distortion_json(surface.report.distortion)}};
  json["arrays"] = std::move(arrays.json);
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.append((4 - text.size() % 4) % 4, ' ');
  std::string bytes(4, '\0');
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>((text.size() >> (8 * i)) & 0xffU);
  return std::make_shared<const std::string>(bytes + text + arrays.bytes);
}

}  // namespace papilla::app
