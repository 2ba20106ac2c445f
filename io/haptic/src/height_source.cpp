// SPDX-License-Identifier: MIT
#include "papilla/io/height_source.hpp"

#include <span>
#include <string>

#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/referenced_file.hpp"
#include "papilla/haptic/channel_average.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/decode_grey16.hpp"
#include "papilla/io/tag_manifest.hpp"

namespace papilla {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// The member of the tag, with which the codes of warnings begin, and what it is called.
struct Kind {
  const char *name, *what;
};
constexpr Kind k_height{"height", "height map"}, k_maps{"maps", "picture of the maps"};

class Finder {
 public:
  Finder(const PlacedPicture& tag, const Kind& kind, std::vector<HapticWarning>& warnings)
      : tag_(tag), kind_(kind), warnings_(warnings) {}

  std::optional<std::string> bytes(const Scene& scene, const std::filesystem::path& file, std::size_t material) const {
    if (auto found = from_uri(tag_.uri, file, material)) return found;
    if (const EncodedImage* image = from_image(scene))
      return std::string(reinterpret_cast<const char*>(image->bytes.data()), image->bytes.size());
    const std::string* shared = tag_.uri.empty() ? tag_picture(scene, tag_.sha256) : nullptr;
    return shared ? from_uri(*shared, file, material) : std::nullopt;
  }

  /// What `make` makes of the picture's bytes; nothing, with a warning, when they are none.
  template <class Make>
  auto decoded(const Scene& scene, const std::filesystem::path& file, std::size_t material, const Make& make) const
      -> std::optional<decltype(make(std::span<const std::byte>(), std::string()))> {
    const auto found = bytes(scene, file, material);
    if (!found) return std::nullopt;
    try {
      return make(bytes_of(*found), tag_.image.empty() ? kind_.what : "image '" + shown(tag_.image) + "'");
    } catch (const Error& error) {
      warn("_image", error.what());
      return std::nullopt;
    }
  }

  void check(int width, int height, bool is_fine, int bits) const {
    if (!is_fine)
      warn("_bits",
           std::string("the ") + kind_.what + " has " + std::to_string(bits) + " bits a sample, steps can be felt");
    if (tag_.size[0] > 0 && (tag_.size[0] != width || tag_.size[1] != height))
      warn("_size", std::string("the ") + kind_.what + " is " + std::to_string(width) + " x " + std::to_string(height) +
                        ", the tag says otherwise");
  }

 private:
  void warn(const char* code, std::string message) const {
    warnings_.push_back({std::string(kind_.name) + code, std::move(message)});
  }

  bool matches(std::span<const std::byte> bytes, const std::string& place) const {
    if (!tag_.sha256.empty() && sha256_hex(bytes) == tag_.sha256) return true;
    warn("_sha256", place + ": is not the map that the tag describes (SHA-256 differs)");
    return false;
  }

  std::optional<std::string> from_uri(const std::string& uri, const std::filesystem::path& file,
                                      std::size_t material) const {
    if (uri.empty()) return std::nullopt;
    if (uri.starts_with("data:")) {
      auto bytes = decode_data_uri(uri);
      if (!bytes) warn("_data_uri", std::string("the data: URI of the ") + kind_.what + " is not base64");
      return bytes && matches(bytes_of(*bytes), "data: URI") ? bytes : std::nullopt;
    }
    const Reference reference{
        file.parent_path(),
        file.string() + ": at /materials/" + std::to_string(material) + "/extras/haptic/" + kind_.name + "/uri",
        percent_decoded(uri)};
    auto bytes = read_reference(reference, ReferenceContent::png);
    if (!bytes) warn("_file", "'" + shown(reference.value) + "' is missing");
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
    if (!named) warn("_image", "the file holds no image of the name '" + shown(tag_.image) + "'");
    return nullptr;
  }

  const PlacedPicture& tag_;
  const Kind& kind_;
  std::vector<HapticWarning>& warnings_;
};

}  // namespace

std::optional<std::string> find_height_bytes(const HeightTag& tag, const Scene& scene,
                                             const std::filesystem::path& file, std::size_t material,
                                             std::vector<HapticWarning>& warnings) {
  return Finder(tag, k_height, warnings).bytes(scene, file, material);
}

std::optional<std::string> find_maps_bytes(const MapsTag& tag, const Scene& scene, const std::filesystem::path& file,
                                           std::size_t material, std::vector<HapticWarning>& warnings) {
  return Finder(tag, k_maps, warnings).bytes(scene, file, material);
}

std::optional<HeightField> find_height_map(const HeightTag& tag, const Scene& scene, const std::filesystem::path& file,
                                           std::size_t material, std::vector<HapticWarning>& warnings) {
  const Finder finder(tag, k_height, warnings);
  return finder.decoded(scene, file, material, [&](std::span<const std::byte> bytes, const std::string& name) {
    Grey16 grey = decode_grey16(bytes, name);
    finder.check(grey.width, grey.height, grey.bits == 16, grey.bits);
    return HeightField(
        grey.width, grey.height, std::move(grey.values),
        {tag.scale_m, tag.offset_m, tag.white_is_outward, tag.uv_transform, tag.wrap, Interpolation::bicubic});
  });
}

std::optional<ChannelField> find_maps(const MapsTag& tag, const Scene& scene, const std::filesystem::path& file,
                                      std::size_t material, std::vector<HapticWarning>& warnings, double probe_radius_m,
                                      Vec2 metres_per_uv) {
  const Finder finder(tag, k_maps, warnings);
  return finder.decoded(scene, file, material, [&](std::span<const std::byte> bytes, const std::string& name) {
    Rgb16 rgb = decode_rgb16(bytes, name);
    finder.check(rgb.width, rgb.height, rgb.bits >= 8, rgb.bits);
    rgb.values = average_texels(std::move(rgb.values), rgb.width, rgb.height, tag.uv_transform, tag.wrap,
                                probe_radius_m, metres_per_uv);
    return ChannelField(rgb.width, rgb.height, std::move(rgb.values), {tag.channels, tag.uv_transform, tag.wrap});
  });
}

}  // namespace papilla
