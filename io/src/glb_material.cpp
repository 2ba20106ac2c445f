// SPDX-License-Identifier: MIT
#include "glb_document.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/image_file.hpp"
#include "picture_input.hpp"

namespace papilla {
namespace {

using Json = GlbBuffer::Json;

constexpr int k_max_tex_coords = 2;

double in_unit_range(double value, const std::string& where) {
  if (!std::isfinite(value)) throw InvalidInput(where + ": a factor is not finite");
  return std::clamp(value, 0.0, 1.0);
}

void add_name_and_extras(Json& json, const std::string& name, const std::string& extras, const std::string& where) {
  if (!name.empty()) json["name"] = name;
  if (!extras.empty()) json["extras"] = parse_scene_json(extras, where + ".extras");
}

template <std::size_t N>
Json numbers(const std::array<double, N>& values, const std::string& where) {
  Json array = Json::array();
  for (const double value : values) array.push_back(in_unit_range(value, where));
  return array;
}

constexpr const char *k_webp = "EXT_texture_webp", *k_webp_type = "image/webp";

/// Of lossy coding, 1 to 100. Light shows errors of a normal map where a colour hides them.
constexpr int k_picture_quality = 85, k_normal_map_quality = 95;

/// Pixels along the longest side of a picture whose size is unknown (KTX2, DDS): more than any of them has.
constexpr int k_unknown_side = 16384;

constexpr double k_unseen_emission = 1.01e-4;  // A third of the first step of 8-bit sRGB, and some rounding.

/// Red light that a tagged material gives off so that no two of them look exactly alike: programs that merge materials
/// by their look would drop tags.
double distinct_emission(std::size_t material) { return 1e-7 * static_cast<double>(1 + material % 1000); }

}  // namespace

int largest_tex_coord(const Json& json) {
  int largest = -1;
  if (json.is_object() && json.contains("index") && json["index"].is_number_integer())
    largest = json.value("texCoord", 0);
  if (json.is_structured())
    for (const auto& child : json) largest = std::max(largest, largest_tex_coord(child));
  return largest;
}

Json texture_transform_json(const UvTransform& transform) {
  Json json = Json::object();
  if (!(transform.offset == Vec2{0, 0})) json["offset"] = {transform.offset.x, transform.offset.y};
  if (transform.rotation != 0) json["rotation"] = transform.rotation;
  if (!(transform.scale == Vec2{1, 1})) json["scale"] = {transform.scale.x, transform.scale.y};
  return json;
}

Json parse_scene_json(const std::string& text, const std::string& where) {
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw InvalidInput("write_glb: " + where + " is no JSON");
  return json;
}

/// Pictures that haptic tags name stay as they are in every byte.
void MaterialWriter::recode_images() {
  std::set<std::string> of_tags;
  std::set<std::size_t> normal_maps;
  for (const Material& material : scene_.materials) {
    if (const auto& normal = material.normal_texture; normal && normal->texture < scene_.textures.size())
      if (const auto& image = scene_.textures[normal->texture].image) normal_maps.insert(*image);
    if (!material.haptic) continue;
    MaterialTag tag = *material.haptic;
    for (const PlacedPicture* picture : pictures_of(tag)) of_tags.insert({picture->image, picture->sha256});
  }
  for (std::size_t i = 0; i < scene_.images.size(); ++i) {
    const EncodedImage& image = scene_.images[i];
    if (image.bytes.empty() || (!image.name.empty() && of_tags.contains(image.name)) ||
        of_tags.contains(sha256_hex(image.bytes)))
      continue;
    const int quality = normal_maps.contains(i) ? k_normal_map_quality : k_picture_quality;
    if (auto made = recoded_picture(image, options_.pictures, quality, picture_name(scene_, i)))
      recoded_.emplace(i, *std::move(made));
  }
}

void MaterialWriter::write_images(Json& gltf) {
  image_number_.resize(scene_.images.size());
  if (options_.pictures != PictureCoding::as_is) recode_images();
  for (std::size_t i = 0; i < scene_.images.size(); ++i) {
    const auto made = recoded_.find(i);
    const EncodedImage& image = made == recoded_.end() ? scene_.images[i] : made->second;
    if (image.bytes.empty()) continue;
    Json json = Json::object();
    if (files_ != nullptr)
      json["uri"] = files_->add_picture(image);
    else if (made == recoded_.end())
      json["bufferView"] = buffer_.add_view(image.bytes, GlbBuffer::Target::none);
    else  // It does not outlive this writer.
      json["bufferView"] = buffer_.add_view(std::vector<std::byte>(image.bytes), GlbBuffer::Target::none);
    json["mimeType"] = image.mime_type;
    add_name_and_extras(json, image.name, image.extras_json, fmt::format("image {}", i));
    image_number_[i] = gltf["images"].size();
    gltf["images"].push_back(std::move(json));
    picture_bytes_ += image.bytes.size();
    uncompressed_picture_bytes_ += scene_.images[i].bytes.size();
  }
}

void MaterialWriter::write_textures(Json& gltf) {
  for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
    const Texture& texture = scene_.textures[i];
    const std::string where = fmt::format("texture {}", i);
    Json json = Json::object(), sampler = Json::object();
    if (texture.mag_filter != 0) sampler["magFilter"] = texture.mag_filter;
    if (texture.min_filter != 0) sampler["minFilter"] = texture.min_filter;
    if (texture.wrap_s != 10497) sampler["wrapS"] = texture.wrap_s;
    if (texture.wrap_t != 10497) sampler["wrapT"] = texture.wrap_t;
    if (!sampler.empty()) {
      Json& samplers = gltf["samplers"];
      const auto known = std::find(samplers.begin(), samplers.end(), sampler);
      json["sampler"] = known - samplers.begin();
      if (known == samplers.end()) samplers.push_back(std::move(sampler));
    }
    if (texture.image && *texture.image >= scene_.images.size())
      throw InvalidInput(
          fmt::format("write_glb: {} names image {} of {}", where, *texture.image, scene_.images.size()));
    add_name_and_extras(json, texture.name, texture.extras_json, where);
    if (!texture.extensions_json.empty())
      json["extensions"] = parse_scene_json(texture.extensions_json, where + ".extensions");
    write_sources(texture, json);
    gltf["textures"].push_back(std::move(json));
  }
}

void MaterialWriter::write_sources(const Texture& texture, Json& json) {
  bool core = texture.image.has_value();  // PNG or JPEG, for which glTF needs no extension
  for (const OtherImage& other : texture.others) {
    core = core && other.image != *texture.image;
    if (other.image >= scene_.images.size())
      throw InvalidInput(
          fmt::format("write_glb: texture '{}' names image {} of {}", texture.name, other.image, scene_.images.size()));
    if (const auto& number = image_number_[other.image]) json["extensions"][other.extension]["source"] = *number;
  }
  if (core && image_number_[*texture.image]) {
    const auto made = recoded_.find(*texture.image);
    if (made == recoded_.end() || made->second.mime_type != k_webp_type) {
      json["source"] = *image_number_[*texture.image];
    } else {
      json["extensions"][k_webp]["source"] = *image_number_[*texture.image];
      required_.insert(k_webp);
    }
  } else if (!texture.others.empty()) {
    required_.insert(texture.others.front().extension);
  }
}

bool MaterialWriter::is_usable(const TextureReference& reference) const {
  if (reference.texture >= scene_.textures.size())
    throw InvalidInput(
        fmt::format("write_glb: a material names texture {} of {}", reference.texture, scene_.textures.size()));
  const Texture& texture = scene_.textures[reference.texture];
  const bool has_picture = texture.image && image_number_[*texture.image];
  return (has_picture || !texture.extensions_json.empty()) && reference.tex_coord < k_max_tex_coords;
}

Json MaterialWriter::reference(const TextureReference& reference, const char* factor_name, MaterialNeeds& needs) const {
  Json json = {{"index", reference.texture}};
  if (reference.tex_coord != 0) json["texCoord"] = reference.tex_coord;
  if (*factor_name != '\0' && reference.factor != 1) json[factor_name] = reference.factor;
  if (reference.transform) json["extensions"]["KHR_texture_transform"] = texture_transform_json(*reference.transform);
  needs.tex_coords = std::max(needs.tex_coords, reference.tex_coord + 1);
  return json;
}

/// A picture that can't be decoded counts as large.
int MaterialWriter::longest_side(std::size_t image) const {
  const auto [known, is_new] = longest_side_.try_emplace(image, k_unknown_side);
  if (is_new && image_number_[image]) try {
      const io_detail::PictureInput picture(scene_.images[image].bytes, picture_name(scene_, image),
                                            k_max_image_pixels);
      known->second = std::max(picture.width(), picture.height());
    } catch (const Error&) {
    }
  return known->second;
}

void MaterialWriter::note_texels(int tex_coord, const std::optional<UvTransform>& transform, int longest_side,
                                 MaterialNeeds& needs) const {
  if (tex_coord < 0 || tex_coord >= k_max_tex_coords) return;
  const Vec2 scale = transform ? transform->scale : Vec2{1, 1};
  double& texels = needs.texels_per_uv[static_cast<std::size_t>(tex_coord)];
  texels = std::max(texels, std::max(std::abs(scale.x), std::abs(scale.y)) * longest_side);
}

Json haptic_json(const MaterialTag& tag) {
  MaterialTag without_pictures = tag;
  for (PlacedPicture* picture : pictures_of(without_pictures)) picture->uri.clear();
  Json json = Json::parse(to_json(without_pictures));
  if (tag.height && !tag.height->uri.empty()) json["height"]["uri"] = tag.height->uri;
  if (tag.maps && !tag.maps->uri.empty()) json["maps"]["uri"] = tag.maps->uri;
  return json;
}

Json MaterialWriter::material(std::size_t number) {
  const Material& source = scene_.materials[number];
  const std::string where = fmt::format("write_glb: material {} '{}'", number, source.name);
  MaterialNeeds needs;
  const auto add_texture = [&](Json& owner, const char* name, const std::optional<TextureReference>& texture,
                               const char* factor_name) {
    if (!texture || !is_usable(*texture)) return;
    owner[name] = reference(*texture, factor_name, needs);
    if (options_.meshes == MeshCoding::none) return;
    const auto& image = scene_.textures[texture->texture].image;
    note_texels(texture->tex_coord, texture->transform, image ? longest_side(*image) : k_unknown_side, needs);
  };
  Json json = Json::object();
  add_name_and_extras(json, source.name, source.extras_json, where);
  if (source.haptic) {
    Json& extras = json["extras"];
    if (!extras.is_null() && !extras.is_object())
      throw InvalidInput(where + ": extras that hold a haptic tag must be an object");
    extras["haptic"] = haptic_json(*source.haptic);
    MaterialTag tag = *source.haptic;
    for (const PlacedPicture* picture : pictures_of(tag))
      note_texels(picture->tex_coord, picture->uv_transform,
                  picture->size[0] > 0 ? std::max(picture->size[0], picture->size[1]) : k_unknown_side, needs);
  }
  Json& pbr = json["pbrMetallicRoughness"];
  pbr["baseColorFactor"] = numbers(source.base_color, where);
  pbr["metallicFactor"] = in_unit_range(source.metallic, where);
  pbr["roughnessFactor"] = in_unit_range(source.roughness, where);
  add_texture(pbr, "baseColorTexture", source.base_color_texture, "");
  add_texture(pbr, "metallicRoughnessTexture", source.metallic_roughness_texture, "");
  add_texture(json, "normalTexture", source.normal_texture, "scale");
  add_texture(json, "occlusionTexture", source.occlusion_texture, "strength");
  add_texture(json, "emissiveTexture", source.emissive_texture, "");
  std::array<double, 3> emissive = source.emissive;
  if (source.haptic && emissive[0] <= k_unseen_emission) emissive[0] = distinct_emission(number);
  if (emissive != std::array<double, 3>{0, 0, 0}) json["emissiveFactor"] = numbers(emissive, where);
  if (source.alpha_mode != "OPAQUE") json["alphaMode"] = source.alpha_mode;
  if (source.alpha_mode == "MASK") json["alphaCutoff"] = std::max(source.alpha_cutoff, 0.0);
  if (source.double_sided) json["doubleSided"] = true;
  if (!source.extensions_json.empty()) {
    json["extensions"] = parse_scene_json(source.extensions_json, where + ".extensions");
    const int largest = largest_tex_coord(json["extensions"]);
    needs.tex_coords = std::max(needs.tex_coords, largest + 1);
    for (int i = 0; i <= largest; ++i) note_texels(i, std::nullopt, k_unknown_side, needs);
  }
  needs.tex_coords = std::min(needs.tex_coords, k_max_tex_coords);
  needs.tangents =
      json.contains("normalTexture") || source.extensions_json.find("clearcoatNormalTexture") != std::string::npos;
  if (json.contains("normalTexture")) needs.tangent_tex_coord = source.normal_texture->tex_coord;
  needs_.push_back(needs);
  return json;
}

void MaterialWriter::write(Json& gltf) {
  write_images(gltf);
  write_textures(gltf);
  for (std::size_t i = 0; i < scene_.materials.size(); ++i) gltf["materials"].push_back(material(i));
  if (!scene_.materials.empty()) share_tag_pictures(gltf["materials"]);
}

}  // namespace papilla
