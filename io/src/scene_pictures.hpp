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
  /// @param line  of the file in which the name stands.
  /// @throws InvalidInput as locate(), and when the file is no picture.
  std::optional<std::uint32_t> add_texture(const std::string& name, std::size_t line, bool clamp);

  /// The picture's file: as named, with Windows separators, or under its bare name in the folder. Empty, with a
  /// warning, when there is none.
  /// @throws InvalidInput as resolve_reference(), unless the folder holds a file of the bare name.
  std::filesystem::path locate(const std::string& name, std::size_t line);

  /// Adds a warning for a picture of a known format that can't be decoded.
  /// @throws InvalidInput with the place and the reason when the file begins as no picture does.
  void note_undecoded(const std::filesystem::path& picture, std::size_t line, const std::string& reason);

 private:
  std::string place(std::size_t line) const { return file_.string() + ": line " + std::to_string(line); }
  std::optional<std::uint32_t> add_image(const std::string& name, std::size_t line);
  EncodedImage load_image(const std::filesystem::path& picture) const;

  std::filesystem::path file_;
  Scene& scene_;
  std::set<std::string> missing_;
  std::map<std::pair<std::string, bool>, std::uint32_t> textures_;
  std::map<std::string, std::uint32_t> images_;
};

}  // namespace papilla
