// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Adds the pictures that a mesh or material file names to its scene, each once. One that is missing or no picture is
/// a warning. PNG and JPEG stay as they are, others become PNG.
class ScenePictures {
 public:
  /// @param folder  of the file that names the pictures.
  ScenePictures(std::filesystem::path folder, Scene& scene) : folder_(std::move(folder)), scene_(scene) {}

  /// The texture that shows the picture, new or known; nothing when the picture can't be had.
  std::optional<std::uint32_t> add_texture(const std::string& name, bool clamp);

  /// The picture's file: as named, with Windows separators, or under its bare name in the folder. Empty, with a
  /// warning, when there is none.
  std::filesystem::path locate(const std::string& name);

 private:
  std::optional<std::uint32_t> add_image(const std::string& name);
  EncodedImage load_image(const std::filesystem::path& file) const;

  std::filesystem::path folder_;
  Scene& scene_;
  std::set<std::string> missing_;
  std::map<std::pair<std::string, bool>, std::uint32_t> textures_;
  std::map<std::string, std::uint32_t> images_;
};

}  // namespace papilla
