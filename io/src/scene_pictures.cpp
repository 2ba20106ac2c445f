// SPDX-License-Identifier: MIT
#include "scene_pictures.hpp"

#include <algorithm>
#include <span>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/referenced_file.hpp"
#include "papilla/io/image_file.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

std::vector<std::byte> to_bytes(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

fs::path ScenePictures::locate(const std::string& name, const std::string& where) {
  std::string slashed = name;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  std::string refusal;
  for (const std::string& candidate : {name, slashed, fs::path(slashed).filename().string()}) try {
      if (const auto file = resolve_reference({file_.parent_path(), place(where), candidate})) return *file;
    } catch (const InvalidInput& error) {
      if (refusal.empty()) refusal = error.what();
    }
  if (!refusal.empty()) throw InvalidInput(refusal);
  if (missing_.insert(name).second) scene_.warnings.push_back("texture '" + shown(name) + "' is missing");
  return {};
}

void ScenePictures::note_undecoded(const fs::path& picture, const std::string& where, const std::string& reason) {
  if (picture_mime_type(read_file(picture)).empty()) throw InvalidInput(place(where) + ": " + reason);
  scene_.warnings.push_back(shown(reason));
}

std::optional<std::uint32_t> ScenePictures::add_texture(const std::string& name, const std::string& where, bool clamp) {
  const auto key = std::make_pair(name, clamp);
  if (const auto known = textures_.find(key); known != textures_.end()) return known->second;
  const auto image = add_image(name, where);
  if (!image) return std::nullopt;
  Texture texture;
  texture.image = image;
  texture.name = scene_.images[*image].name;
  if (clamp) texture.wrap_s = texture.wrap_t = 33071;
  scene_.textures.push_back(std::move(texture));
  return textures_[key] = static_cast<std::uint32_t>(scene_.textures.size() - 1);
}

std::optional<std::uint32_t> ScenePictures::add_image(const std::string& name, const std::string& where) {
  if (const auto known = images_.find(name); known != images_.end()) return known->second;
  const fs::path picture = locate(name, where);
  if (picture.empty()) return std::nullopt;
  try {
    scene_.images.push_back(load_image(picture));
  } catch (const InvalidInput& error) {
    note_undecoded(picture, where, error.what());
    return std::nullopt;
  }
  return images_[name] = static_cast<std::uint32_t>(scene_.images.size() - 1);
}

EncodedImage ScenePictures::load_image(const fs::path& picture) const {
  std::error_code error;
  EncodedImage image;
  image.name = picture.stem().string();
  image.uri = picture.lexically_relative(fs::weakly_canonical(fs::absolute(file_, error).parent_path(), error))
                  .generic_string();
  const std::string bytes = read_file(picture);
  image.mime_type = picture_mime_type(bytes);
  if (image.mime_type == "image/png" || image.mime_type == "image/jpeg") {
    image.bytes = to_bytes(bytes);
  } else {
    image.mime_type = "image/png";
    image.bytes = encode_png(read_color_image(picture));
  }
  return image;
}

}  // namespace papilla
