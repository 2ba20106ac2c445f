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

/// Adds the pictures that a mesh or material file names to its scene, each once. One that is missing, or of a format
/// that can't be decoded, is a warning. PNG and JPEG stay as they are, others become PNG.
class ScenePictures {
 public:
  /// @param file  that names the pictures.
  ScenePictures(std::filesystem::path file, Scene& scene) : file_(std::move(file)), scene_(scene) {}

  /// The texture that shows the picture, new or known; nothing when the picture can't be had.
  /// @param where  in the file the name stands: "line 3".
  /// @throws InvalidInput as locate(), and when the file is no picture.
  std::optional<std::uint32_t> add_texture(const std::string& name, const std::string& where, bool clamp);

  /// The same without a texture.
  std::optional<std::uint32_t> add_image(const std::string& name, const std::string& where);

  /// The picture's file: as named, with Windows separators, or under its bare name in the folder. Empty, with a
  /// warning, when there is none.
  /// @throws InvalidInput as resolve_reference(), unless the folder holds a file of the bare name.
  std::filesystem::path locate(const std::string& name, const std::string& where);

  /// Adds a warning for a picture of a known format that can't be decoded.
  /// @throws InvalidInput with the place and the reason when the file begins as no picture does.
  void note_undecoded(const std::filesystem::path& picture, const std::string& where, const std::string& reason);

 private:
  std::string place(const std::string& where) const { return file_.string() + ": " + where; }
  EncodedImage load_image(const std::filesystem::path& picture) const;

  std::filesystem::path file_;
  Scene& scene_;
  std::set<std::string> missing_;
  std::map<std::pair<std::string, bool>, std::uint32_t> textures_;
  std::map<std::string, std::uint32_t> images_;
};

}  // namespace papilla
