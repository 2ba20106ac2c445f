// SPDX-License-Identifier: MIT
#include "glb_document.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "papilla/core/base64.hpp"

namespace papilla {
namespace {

using Json = GlbBuffer::Json;

constexpr const char* k_mpeg = "MPEG_material_haptic";
constexpr const char* k_khr = "KHR_physics_rigid_bodies";

/// By number of a glTF material: its number among the mirrored ones.
using Mirrored = std::map<std::size_t, std::size_t>;

const Json* member(const Json& json, const char* name) {
  const auto found = json.is_object() ? json.find(name) : json.end();
  return found == json.end() ? nullptr : &*found;
}

const Json* haptic_tag(const Json& material) {
  const Json* extras = member(material, "extras");
  const Json* tag = extras == nullptr ? nullptr : member(*extras, "haptic");
  return tag != nullptr && tag->is_object() ? tag : nullptr;
}

std::optional<double> number(const Json& json, const char* name) {
  const Json* value = member(json, name);
  return value != nullptr && value->is_number() ? std::optional(value->get<double>()) : std::nullopt;
}

std::string name_of(const Json& json) {
  const Json* name = member(json, "name");
  return name != nullptr && name->is_string() ? name->get<std::string>() : std::string();
}

Json named(const std::string& name) { return name.empty() ? Json::object() : Json{{"name", name}}; }

struct MeshMaterial {
  std::optional<std::size_t> mirrored;  ///< The mirrored material of all primitives.
  bool is_one_of_several = false;
};

MeshMaterial material_of_mesh(const Json& mesh, const Mirrored& mirrored) {
  std::set<std::optional<std::size_t>> used;
  for (const Json& primitive : mesh["primitives"]) {
    const Json* material = member(primitive, "material");
    const auto found = material == nullptr ? mirrored.end() : mirrored.find(material->get<std::size_t>());
    used.insert(found == mirrored.end() ? std::nullopt : std::optional(found->second));
  }
  if (used.size() == 1) return {*used.begin(), false};
  return {std::nullopt, used.size() > 1};
}

/// Writes the pictures of height maps, each once.
class MapTextures {
 public:
  MapTextures(Json& gltf, GlbBuffer& buffer) : gltf_(gltf), buffer_(buffer) {}

  /// The texture of a tag's map; nothing when no tag holds the picture itself.
  std::optional<std::size_t> texture_of(const Json& materials, const Json& height, const std::string& name) {
    const std::string* uri = tag_picture_uri(materials, height);
    if (uri == nullptr) return std::nullopt;
    const auto [known, is_new] = textures_.try_emplace(*uri);
    if (is_new) known->second = write(known->first, name);
    return known->second;
  }

 private:
  std::optional<std::size_t> write(std::string_view uri, const std::string& name) {
    const std::optional<std::string> bytes = decode_data_uri(uri);
    if (!bytes) return std::nullopt;
    Json image = named(name);
    image["bufferView"] = buffer_.add_view(std::vector<char>(bytes->begin(), bytes->end()), GlbBuffer::Target::none);
    image["mimeType"] = "image/png";
    Json texture = named(name);
    texture["source"] = gltf_["images"].size();
    gltf_["images"].push_back(std::move(image));
    gltf_["textures"].push_back(std::move(texture));
    return gltf_["textures"].size() - 1;
  }

  Json& gltf_;
  GlbBuffer& buffer_;
  std::map<std::string_view, std::optional<std::size_t>> textures_;
};

/// With the texture channel and transform of the normal texture, which shows the same relief.
Json texture_info(std::size_t texture, const Json& material) {
  Json info = {{"index", texture}};
  if (const Json* normal = member(material, "normalTexture"))
    for (const char* shared : {"texCoord", "extensions"})
      if (const Json* value = member(*normal, shared)) info[shared] = *value;
  return info;
}

Json mpeg_material(const Json& material, const Json& height, std::size_t texture) {
  Json layer = {{"texture", texture_info(texture, material)}, {"type", "High_Resolution"}};
  for (const char* measure : {"scale", "offset", "metresPerUV"})
    if (const Json* value = member(height, measure)) layer["extras"][measure] = *value;
  Json json = named(name_of(material));
  json["vibrotactileTexture"] = Json::array({std::move(layer)});
  return json;
}

Json physics_material(const Json& material, const Json& tag) {
  const auto fixed = number(tag, "staticFriction"), sliding = number(tag, "dynamicFriction");
  Json json = named(name_of(material));
  json["staticFriction"] = fixed.value_or(sliding.value_or(0));
  json["dynamicFriction"] = sliding.value_or(fixed.value_or(0));
  json["restitution"] = 0;
  return json;
}

bool shows_materials(const Json& gltf) {
  return gltf.contains("materials") && gltf.contains("meshes") && gltf.contains("nodes");
}

std::set<std::size_t> levels_of_detail(const Json& nodes) {
  std::set<std::size_t> levels;
  for (const Json& node : nodes)
    if (const Json* extensions = member(node, "extensions"))
      if (const Json* lod = member(*extensions, "MSFT_lod"))
        for (const Json& id : (*lod)["ids"]) levels.insert(id.get<std::size_t>());
  return levels;
}

void note_several(const char* extension, const std::string& name, std::vector<std::string>& not_mirrored) {
  not_mirrored.push_back(fmt::format("{}: mesh '{}' has several materials, the draft allows one", extension, name));
}

}  // namespace

std::vector<std::string> mirror_mpeg_haptics(Json& gltf, GlbBuffer& buffer) {
  std::vector<std::string> not_mirrored;
  if (!shows_materials(gltf)) return not_mirrored;
  Mirrored mirrored;
  Json materials = Json::array();
  MapTextures maps(gltf, buffer);
  // Taken out while the loop adds images and textures, which moves the members of gltf.
  Json sources = std::move(gltf["materials"]);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const Json* tag = haptic_tag(sources[i]);
    const Json* height = tag == nullptr ? nullptr : member(*tag, "height");
    if (height == nullptr) continue;
    const std::string name = name_of(sources[i]);
    if (const auto texture = maps.texture_of(sources, *height, name)) {
      mirrored[i] = materials.size();
      materials.push_back(mpeg_material(sources[i], *height, *texture));
    } else {
      not_mirrored.push_back(fmt::format("{}: the height map of '{}' is not within its tag", k_mpeg, name));
    }
  }
  gltf["materials"] = std::move(sources);
  if (materials.empty()) return not_mirrored;
  for (Json& mesh : gltf["meshes"]) {
    const MeshMaterial used = material_of_mesh(mesh, mirrored);
    if (used.mirrored) mesh["extensions"][k_mpeg]["hapticMaterialIndex"] = *used.mirrored;
    if (used.is_one_of_several) note_several(k_mpeg, name_of(mesh), not_mirrored);
  }
  gltf["extensions"][k_mpeg]["materials"] = std::move(materials);
  return not_mirrored;
}

void mirror_khr_physics(Json& gltf, std::vector<std::string>& not_mirrored) {
  if (!shows_materials(gltf)) return;
  Mirrored mirrored;
  Json materials = Json::array();
  const Json& sources = gltf["materials"];
  for (std::size_t i = 0; i < sources.size(); ++i)
    if (const Json* tag = haptic_tag(sources[i])) {
      mirrored[i] = materials.size();
      materials.push_back(physics_material(sources[i], *tag));
    }
  if (materials.empty()) return;
  Json& nodes = gltf["nodes"];
  std::vector<MeshMaterial> used;
  for (const Json& mesh : gltf["meshes"]) {
    used.push_back(material_of_mesh(mesh, mirrored));
    if (used.back().is_one_of_several) note_several(k_khr, name_of(mesh), not_mirrored);
  }
  const std::set<std::size_t> levels = levels_of_detail(nodes);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Json* mesh = member(nodes[i], "mesh");
    if (mesh == nullptr || levels.contains(i)) continue;
    if (const auto material = used[mesh->get<std::size_t>()].mirrored)
      nodes[i]["extensions"][k_khr]["collider"] = {{"geometry", {{"node", i}, {"convexHull", false}}},
                                                   {"physicsMaterial", *material}};
  }
  gltf["extensions"][k_khr]["physicsMaterials"] = std::move(materials);
}

}  // namespace papilla
