// SPDX-License-Identifier: MIT
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "assimp_scene.hpp"
#include "papilla/core/referenced_file.hpp"

namespace papilla {
namespace {

constexpr int k_clamp = 33071, k_mirrored = 33648, k_repeat = 10497;

int wrap_of(int mode) {
  return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal ? k_clamp
         : mode == aiTextureMapMode_Mirror                                ? k_mirrored
                                                                          : k_repeat;
}

/// What a texture slot of assimp is called where it has no place.
const char* slot_name(int type) {
  switch (type) {
    case aiTextureType_SPECULAR: return "specular";
    case aiTextureType_AMBIENT: return "ambient";
    case aiTextureType_HEIGHT: return "bump or height";
    case aiTextureType_SHININESS: return "shininess";
    case aiTextureType_OPACITY: return "opacity";
    case aiTextureType_DISPLACEMENT: return "displacement";
    case aiTextureType_REFLECTION: return "reflection";
    case aiTextureType_METALNESS: return "metalness";
    case aiTextureType_DIFFUSE_ROUGHNESS: return "roughness";
    case aiTextureType_CLEARCOAT: return "clearcoat";
    case aiTextureType_SHEEN: return "sheen";
    case aiTextureType_TRANSMISSION: return "transmission";
    default: return "unknown";
  }
}

class MaterialConverter {
 public:
  MaterialConverter(const aiMaterial& from, const aiScene& owner, Tally& losses, Scene& scene)
      : from_(from), owner_(owner), losses_(losses), scene_(scene) {}

  Material convert() {
    Material material;
    aiString name;
    if (from_.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = name.C_Str();
    std::array<double, 3> rgb{1, 1, 1};
    if (color(AI_MATKEY_BASE_COLOR, rgb) || color(AI_MATKEY_COLOR_DIFFUSE, rgb))
      std::copy(rgb.begin(), rgb.end(), material.base_color.begin());
    color(AI_MATKEY_COLOR_EMISSIVE, material.emissive);
    if (const auto opacity = fraction(AI_MATKEY_OPACITY)) material.base_color[3] = *opacity;
    if (material.base_color[3] < 1) material.alpha_mode = "BLEND";
    if (const auto metallic = fraction(AI_MATKEY_METALLIC_FACTOR)) material.metallic = *metallic;
    if (const auto roughness = fraction(AI_MATKEY_ROUGHNESS_FACTOR))
      material.roughness = *roughness;
    else if (const auto exponent = number(AI_MATKEY_SHININESS); exponent && *exponent > 0)
      material.roughness = 1 - std::sqrt(std::min(*exponent, 1000.0) / 1000);  // As of MTL's Ns.
    int two_sided = 0;
    material.double_sided = from_.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS && two_sided != 0;
    convert_textures(material);
    return material;
  }

 private:
  std::optional<double> number(const char* key, unsigned type, unsigned index) const {
    ai_real value = 0;
    if (from_.Get(key, type, index, value) != aiReturn_SUCCESS || !std::isfinite(value)) return std::nullopt;
    return static_cast<double>(value);
  }

  std::optional<double> fraction(const char* key, unsigned type, unsigned index) const {
    const auto value = number(key, type, index);
    return value ? std::optional(std::clamp(*value, 0.0, 1.0)) : std::nullopt;
  }

  bool color(const char* key, unsigned type, unsigned index, std::array<double, 3>& rgb) const {
    aiColor4D c;
    if (from_.Get(key, type, index, c) != aiReturn_SUCCESS) return false;
    if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b)) return false;
    const auto clamped = [](ai_real x) { return std::clamp(static_cast<double>(x), 0.0, 1.0); };
    rgb = {clamped(c.r), clamped(c.g), clamped(c.b)};
    return true;
  }

  void convert_textures(Material& material) {
    using Slot = std::optional<TextureReference>;
    // The first of several that assimp may use for the same purpose counts.
    const std::pair<aiTextureType, Slot*> slots[] = {{aiTextureType_BASE_COLOR, &material.base_color_texture},
                                                     {aiTextureType_DIFFUSE, &material.base_color_texture},
                                                     {aiTextureType_NORMALS, &material.normal_texture},
                                                     {aiTextureType_NORMAL_CAMERA, &material.normal_texture},
                                                     {aiTextureType_AMBIENT_OCCLUSION, &material.occlusion_texture},
                                                     {aiTextureType_LIGHTMAP, &material.occlusion_texture},
                                                     {aiTextureType_EMISSION_COLOR, &material.emissive_texture},
                                                     {aiTextureType_EMISSIVE, &material.emissive_texture}};
    for (int type = aiTextureType_DIFFUSE; type <= AI_TEXTURE_TYPE_MAX; ++type) {
      const auto kind = static_cast<aiTextureType>(type);
      const unsigned count = from_.GetTextureCount(kind);
      if (count == 0) continue;
      const auto* slot =
          std::find_if(std::begin(slots), std::end(slots), [&](const auto& s) { return s.first == kind; });
      if (slot == std::end(slots)) {
        losses_.add(std::string("textures of materials' slot '") + slot_name(type) + "'", count);
        continue;
      }
      losses_.add("textures behind the first of their slot", count - 1);
    }
    for (const auto& [kind, slot] : slots)
      if (!*slot && from_.GetTextureCount(kind) > 0) *slot = reference(kind);
    // A picture stands for the colour, the factor of which many programs leave black.
    if (from_.GetTextureCount(aiTextureType_DIFFUSE) > 0 &&
        material.base_color[0] + material.base_color[1] + material.base_color[2] == 0)
      std::fill_n(material.base_color.begin(), 3, 1.0);
    if (material.emissive_texture && material.emissive == std::array<double, 3>{0, 0, 0}) material.emissive = {1, 1, 1};
  }

  std::optional<TextureReference> reference(aiTextureType kind) {
    aiString path;
    if (from_.Get(AI_MATKEY_TEXTURE(kind, 0), path) != aiReturn_SUCCESS || path.length == 0) return std::nullopt;
    const std::optional<std::uint32_t> image = image_of(path.C_Str());
    if (!image) return std::nullopt;
    TextureReference reference;
    int channel = 0;
    from_.Get(AI_MATKEY_UVWSRC(kind, 0), channel);
    if (channel > 1 || channel < 0) {
      losses_.add("textures on a set of texture coordinates beyond the second");
      return std::nullopt;
    }
    reference.tex_coord = channel;
    aiUVTransform transform;
    if (from_.Get(AI_MATKEY_UVTRANSFORM(kind, 0), transform) == aiReturn_SUCCESS)
      reference.transform = uv_transform(transform);
    Texture texture;
    texture.image = image;
    texture.name = scene_.images[*image].name;
    int mode = aiTextureMapMode_Wrap;
    if (from_.Get(AI_MATKEY_MAPPINGMODE_U(kind, 0), mode) == aiReturn_SUCCESS) texture.wrap_s = wrap_of(mode);
    mode = aiTextureMapMode_Wrap;
    if (from_.Get(AI_MATKEY_MAPPINGMODE_V(kind, 0), mode) == aiReturn_SUCCESS) texture.wrap_t = wrap_of(mode);
    reference.texture = static_cast<std::uint32_t>(scene_.textures.size());
    scene_.textures.push_back(std::move(texture));
    return reference;
  }

  /// glTF's form of uv' = scale · uv + offset, where v runs up; rotations are a loss.
  std::optional<UvTransform> uv_transform(const aiUVTransform& t) {
    const Vec2 scale{t.mScaling.x, t.mScaling.y}, offset{t.mTranslation.x, t.mTranslation.y};
    if (!is_finite(scale) || !is_finite(offset) || !std::isfinite(t.mRotation)) return std::nullopt;
    if (t.mRotation != 0) losses_.add("rotations of textures");
    if (scale == Vec2{1, 1} && offset == Vec2{0, 0}) return std::nullopt;
    return UvTransform{{offset.x, 1 - scale.y - offset.y}, 0, scale};
  }

  std::optional<std::uint32_t> image_of(const std::string& path) {
    const aiTexture* embedded = owner_.GetEmbeddedTexture(path.c_str());
    if (embedded == nullptr && path.front() == '*') {
      losses_.add("embedded pictures that assimp does not find");
      return std::nullopt;
    }
    const auto known = std::find_if(scene_.images.begin(), scene_.images.end(),
                                    [&](const EncodedImage& image) { return image.uri == path; });
    if (known != scene_.images.end()) return static_cast<std::uint32_t>(known - scene_.images.begin());
    EncodedImage image;
    image.uri = path;
    if (embedded != nullptr) {
      // mHeight 0: a picture file of mWidth bytes.
      const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(embedded->pcData),
                                             embedded->mHeight == 0 ? embedded->mWidth : 0);
      image.mime_type = picture_mime_type({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      if (image.mime_type != "image/png" && image.mime_type != "image/jpeg") {
        losses_.add("embedded pictures that are neither PNG nor JPEG");
        return std::nullopt;
      }
      image.name = std::filesystem::path(embedded->mFilename.C_Str()).stem().string();
      image.bytes.assign(bytes.begin(), bytes.end());
    }
    scene_.images.push_back(std::move(image));
    return static_cast<std::uint32_t>(scene_.images.size() - 1);
  }

  const aiMaterial& from_;
  const aiScene& owner_;
  Tally& losses_;
  Scene& scene_;
};

}  // namespace

void convert_assimp_material(const aiMaterial& from, const aiScene& owner, Tally& losses, Scene& scene) {
  Material material = MaterialConverter(from, owner, losses, scene).convert();
  scene.materials.push_back(std::move(material));
}

}  // namespace papilla
