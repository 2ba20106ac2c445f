// SPDX-License-Identifier: MIT
#include "gltf_document.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "json_text.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/referenced_file.hpp"

namespace papilla::gltf {
namespace {

EncodedImage read_image(const tinygltf::Image& source, std::size_t number, AccessorReader& reader, Scene& scene) {
  EncodedImage image;
  image.name = source.name;
  image.uri = percent_decoded(source.uri);
  image.extras_json = source.extras_json_string;
  const std::string where = "image " + std::to_string(number);
  const auto bytes =
      source.bufferView >= 0 ? reader.view(source.bufferView, where) : std::span<const unsigned char>(source.image);
  image.bytes.assign(std::as_bytes(bytes).begin(), std::as_bytes(bytes).end());
  image.mime_type = picture_mime_type({reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size()});
  if (image.mime_type.empty()) image.mime_type = source.mimeType;  // Embedded, and of no known format.
  if (image.bytes.empty()) scene.warnings.push_back(where + " '" + shown(image.uri) + "' is missing");
  return image;
}

class MaterialReader {
 public:
  explicit MaterialReader(const Document& document) : document_(document) {}

  Material read(const tinygltf::Material& source, std::size_t number) const {
    const std::string where = "material " + std::to_string(number);
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    Material material;
    material.name = source.name;
    std::copy_n(pbr.baseColorFactor.begin(), 4, material.base_color.begin());
    material.metallic = pbr.metallicFactor;
    material.roughness = pbr.roughnessFactor;
    std::copy_n(source.emissiveFactor.begin(), 3, material.emissive.begin());
    material.double_sided = source.doubleSided;
    material.alpha_mode = source.alphaMode;
    material.alpha_cutoff = source.alphaCutoff;
    material.base_color_texture = reference(pbr.baseColorTexture, 1, where + ", baseColorTexture");
    material.metallic_roughness_texture =
        reference(pbr.metallicRoughnessTexture, 1, where + ", metallicRoughnessTexture");
    material.normal_texture = reference(source.normalTexture, source.normalTexture.scale, where + ", normalTexture");
    material.occlusion_texture =
        reference(source.occlusionTexture, source.occlusionTexture.strength, where + ", occlusionTexture");
    material.emissive_texture = reference(source.emissiveTexture, 1, where + ", emissiveTexture");
    material.extras_json = source.extras_json_string;
    material.haptic = take_material_tag(material.extras_json, material.haptic_warnings);
    material.extensions_json = source.extensions_json_string;
    check(material, where);
    return material;
  }

 private:
  [[noreturn]] void fail(const std::string& where, const std::string& reason) const {
    throw InvalidInput(document_.file + ": " + where + ": " + reason);
  }

  void check(const Material& material, const std::string& where) const {
    const auto finite = [](double x) { return std::isfinite(x); };
    if (!std::all_of(material.base_color.begin(), material.base_color.end(), finite) ||
        !std::all_of(material.emissive.begin(), material.emissive.end(), finite) || !finite(material.metallic) ||
        !finite(material.roughness) || !finite(material.alpha_cutoff))
      fail(where, "a factor is not finite");
    if (material.alpha_mode != "OPAQUE" && material.alpha_mode != "MASK" && material.alpha_mode != "BLEND")
      fail(where, "alphaMode '" + printable(material.alpha_mode) + "' is unknown");
  }

  template <class Info>
  std::optional<TextureReference> reference(const Info& info, double factor, const std::string& where) const {
    if (info.index == -1) return std::nullopt;
    if (info.index < 0 || static_cast<std::size_t>(info.index) >= document_.model.textures.size())
      fail(where, "texture " + std::to_string(info.index) + " does not exist");
    if (info.texCoord < 0) fail(where, "texCoord " + std::to_string(info.texCoord) + " is negative");
    if (!std::isfinite(factor)) fail(where, "the factor is not finite");
    TextureReference result{static_cast<std::uint32_t>(info.index), info.texCoord, factor, std::nullopt};
    if (!info.extensions_json_string.empty()) read_transform(info.extensions_json_string, where, result);
    return result;
  }

  Vec2 read_pair(const Json& object, const char* key, Vec2 fallback, const std::string& where) const {
    const auto found = object.find(key);
    if (found == object.end()) return fallback;
    if (!found->is_array() || found->size() != 2 || !(*found)[0].is_number() || !(*found)[1].is_number())
      fail(where, std::string("KHR_texture_transform.") + key + " is not two numbers");
    return {(*found)[0].get<double>(), (*found)[1].get<double>()};
  }

  void read_transform(const std::string& extensions, const std::string& where, TextureReference& result) const {
    const auto json = json_of(extensions);
    const auto found = json.is_object() ? json.find("KHR_texture_transform") : json.end();
    if (found == json.end() || !found->is_object()) return;
    UvTransform transform;
    transform.offset = read_pair(*found, "offset", transform.offset, where);
    transform.scale = read_pair(*found, "scale", transform.scale, where);
    if (const auto rotation = found->find("rotation"); rotation != found->end() && rotation->is_number())
      transform.rotation = rotation->get<double>();
    if (const auto channel = found->find("texCoord"); channel != found->end() && channel->is_number_unsigned())
      result.tex_coord = static_cast<int>(std::min<std::uint64_t>(channel->get<std::uint64_t>(), 1000));
    if (!is_finite(transform.offset) || !is_finite(transform.scale) || !std::isfinite(transform.rotation))
      fail(where, "KHR_texture_transform is not finite");
    result.transform = transform;
  }

  const Document& document_;
};

/// Formats that extensions bring, those that most programs read first.
constexpr std::array k_image_extensions = {"EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds",
                                           "KHR_texture_basisu"};

/// Takes the pictures of other formats out of the texture's extensions.
void take_other_images(std::size_t image_count, const std::string& where, Texture& texture) {
  Json extensions = json_of(texture.extensions_json);
  if (!extensions.is_object()) return;
  for (const char* name : k_image_extensions) {
    const auto found = extensions.find(name);
    if (found == extensions.end()) continue;
    const Json* source = found->is_object() && found->contains("source") ? &(*found)["source"] : nullptr;
    if (source != nullptr) {
      if (!source->is_number_unsigned() || source->get<std::uint64_t>() >= image_count)
        throw InvalidInput(where + ": " + name + ": image " + source->dump() + " does not exist");
      texture.others.push_back({name, source->get<std::uint32_t>()});
    }
    extensions.erase(name);
  }
  texture.extensions_json = extensions.empty() ? "" : text_of(extensions);
  if (!texture.image && !texture.others.empty()) texture.image = texture.others.front().image;
}

Texture read_texture(const tinygltf::Texture& source, std::size_t number, const Document& document) {
  const tinygltf::Model& model = document.model;
  const std::string where = document.file + ": texture " + std::to_string(number);
  Texture texture;
  texture.name = source.name;
  texture.extras_json = source.extras_json_string;
  texture.extensions_json = source.extensions_json_string;
  if (source.source >= static_cast<int>(model.images.size()))
    throw InvalidInput(where + ": image " + std::to_string(source.source) + " does not exist");
  if (source.source >= 0) texture.image = static_cast<std::uint32_t>(source.source);
  take_other_images(model.images.size(), where, texture);
  if (source.sampler >= static_cast<int>(model.samplers.size()))
    throw InvalidInput(where + ": sampler " + std::to_string(source.sampler) + " does not exist");
  if (source.sampler >= 0) {
    const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(source.sampler)];
    texture.wrap_s = sampler.wrapS;
    texture.wrap_t = sampler.wrapT;
    texture.min_filter = std::max(sampler.minFilter, 0);
    texture.mag_filter = std::max(sampler.magFilter, 0);
  }
  return texture;
}

}  // namespace

void read_materials(const Document& document, AccessorReader& reader, Scene& scene) {
  const tinygltf::Model& model = document.model;
  for (std::size_t i = 0; i < model.images.size(); ++i)
    scene.images.push_back(read_image(model.images[i], i, reader, scene));
  for (std::size_t i = 0; i < model.textures.size(); ++i)
    scene.textures.push_back(read_texture(model.textures[i], i, document));
  const MaterialReader materials(document);
  for (std::size_t i = 0; i < model.materials.size(); ++i)
    scene.materials.push_back(materials.read(model.materials[i], i));
}

}  // namespace papilla::gltf
