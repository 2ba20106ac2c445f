// SPDX-License-Identifier: MIT
#include "papilla/io/height_source.hpp"

#include <span>
#include <string>

#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/referenced_file.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/decode_grey16.hpp"

namespace papilla {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

class Finder {
 public:
  Finder(const HeightTag& tag, std::vector<HapticWarning>& warnings) : tag_(tag), warnings_(warnings) {}

  bool matches(std::span<const std::byte> bytes, const std::string& place) const {
    if (!tag_.sha256.empty() && sha256_hex(bytes) == tag_.sha256) return true;
    warnings_.push_back({"height_sha256", place + ": is not the map that the tag describes (SHA-256 differs)"});
    return false;
  }

  std::optional<std::string> from_uri(const std::filesystem::path& file, std::size_t material) const {
    if (tag_.uri.empty()) return std::nullopt;
    if (tag_.uri.starts_with("data:")) {
      auto bytes = decode_data_uri(tag_.uri);
      if (!bytes) warnings_.push_back({"height_data_uri", "the data: URI of the height map is not base64"});
      return bytes && matches(bytes_of(*bytes), "data: URI") ? bytes : std::nullopt;
    }
    const Reference reference{
        file.parent_path(), file.string() + ": at /materials/" + std::to_string(material) + "/extras/haptic/height/uri",
        percent_decoded(tag_.uri)};
    auto bytes = read_reference(reference, ReferenceContent::png);
    if (!bytes) warnings_.push_back({"height_file", "'" + shown(reference.value) + "' is missing"});
    return bytes && matches(bytes_of(*bytes), "'" + shown(reference.value) + "'") ? bytes : std::nullopt;
  }

  const EncodedImage* from_image(const Scene& scene) const {
    if (tag_.image.empty()) return nullptr;
    const EncodedImage* named = nullptr;
    for (const EncodedImage& image : scene.images)
      if (image.name == tag_.image) {
        named = &image;
        if (matches(image.bytes, "image '" + shown(image.name) + "'")) return named;
      }
    if (!named)
      warnings_.push_back({"height_image", "the file holds no image of the name '" + shown(tag_.image) + "'"});
    return nullptr;
  }

  HeightField decode(std::span<const std::byte> bytes) const {
    Grey16 grey = decode_grey16(bytes, tag_.image.empty() ? "height map" : "image '" + shown(tag_.image) + "'");
    if (grey.bits != 16)
      warnings_.push_back(
          {"height_bits", "the height map has " + std::to_string(grey.bits) + " bits a sample, steps can be felt"});
    if (tag_.size[0] > 0 && (tag_.size[0] != grey.width || tag_.size[1] != grey.height))
      warnings_.push_back({"height_size", "the height map is " + std::to_string(grey.width) + " x " +
                                              std::to_string(grey.height) + ", the tag says otherwise"});
    return HeightField(
        grey.width, grey.height, std::move(grey.values),
        {tag_.scale_m, tag_.offset_m, tag_.white_is_outward, tag_.uv_transform, tag_.wrap, Interpolation::bicubic});
  }

 private:
  const HeightTag& tag_;
  std::vector<HapticWarning>& warnings_;
};

}  // namespace

std::optional<std::string> find_height_bytes(const HeightTag& tag, const Scene& scene,
                                             const std::filesystem::path& file, std::size_t material,
                                             std::vector<HapticWarning>& warnings) {
  const Finder finder(tag, warnings);
  if (auto bytes = finder.from_uri(file, material)) return bytes;
  const EncodedImage* image = finder.from_image(scene);
  if (!image) return std::nullopt;
  return std::string(reinterpret_cast<const char*>(image->bytes.data()), image->bytes.size());
}

std::optional<HeightField> find_height_map(const HeightTag& tag, const Scene& scene, const std::filesystem::path& file,
                                           std::size_t material, std::vector<HapticWarning>& warnings) {
  const auto bytes = find_height_bytes(tag, scene, file, material, warnings);
  if (!bytes) return std::nullopt;
  try {
    return Finder(tag, warnings).decode(bytes_of(*bytes));
  } catch (const Error& error) {
    warnings.push_back({"height_image", error.what()});
    return std::nullopt;
  }
}

}  // namespace papilla
