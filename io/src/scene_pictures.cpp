// SPDX-License-Identifier: MIT
#include "scene_pictures.hpp"

#include <algorithm>
#include <span>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/read_file.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

std::vector<std::byte> to_bytes(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

fs::path ScenePictures::locate(const std::string& name) {
  std::string slashed = name;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  std::error_code error;  // A name that no file can have is a missing file.
  for (const fs::path& candidate : {folder_ / name, folder_ / slashed, folder_ / fs::path(slashed).filename()})
    if (fs::is_regular_file(candidate, error)) return candidate;
  if (missing_.insert(name).second) scene_.warnings.push_back("texture '" + one_line(name) + "' is missing");
  return {};
}

std::optional<std::uint32_t> ScenePictures::add_texture(const std::string& name, bool clamp) {
  const auto key = std::make_pair(name, clamp);
  if (const auto known = textures_.find(key); known != textures_.end()) return known->second;
  const auto image = add_image(name);
  if (!image) return std::nullopt;
  Texture texture;
  texture.image = image;
  texture.name = scene_.images[*image].name;
  if (clamp) texture.wrap_s = texture.wrap_t = 33071;
  scene_.textures.push_back(std::move(texture));
  return textures_[key] = static_cast<std::uint32_t>(scene_.textures.size() - 1);
}

std::optional<std::uint32_t> ScenePictures::add_image(const std::string& name) {
  if (const auto known = images_.find(name); known != images_.end()) return known->second;
  const fs::path file = locate(name);
  if (file.empty()) return std::nullopt;
  try {
    scene_.images.push_back(load_image(file));
  } catch (const Error& error) {
    scene_.warnings.push_back(one_line(error.what()));
    return std::nullopt;
  }
  return images_[name] = static_cast<std::uint32_t>(scene_.images.size() - 1);
}

EncodedImage ScenePictures::load_image(const fs::path& file) const {
  EncodedImage image;
  image.name = file.stem().string();
  image.uri = file.lexically_relative(folder_).generic_string();
  const std::string bytes = read_file(file);
  if (bytes.starts_with("\x89PNG")) {
    image.mime_type = "image/png";
    image.bytes = to_bytes(bytes);
  } else if (bytes.starts_with("\xff\xd8\xff")) {
    image.mime_type = "image/jpeg";
    image.bytes = to_bytes(bytes);
  } else {
    image.mime_type = "image/png";
    image.bytes = encode_png(read_color_image(file));
  }
  return image;
}

}  // namespace papilla
