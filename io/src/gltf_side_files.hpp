// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Whether a file that is written becomes a .gltf with other files beside it; else it is one GLB.
bool is_gltf_with_files(const std::filesystem::path& output);

/// The relative paths that a part of a document names as "uri", percent encoding undone.
void collect_uris(const nlohmann::ordered_json& json, std::set<std::string>& uris);

/// The files beside a .gltf under construction. New ones are named after it, with letters, digits, '.', '_' and '-', so
/// that their names are URIs as they are.
class GltfSideFiles {
 public:
  explicit GltfSideFiles(std::filesystem::path output);

  /// A file that the input names. It is copied to the same place below the output's folder, unless it is there already.
  /// @param relative  percent encoding undone. @param source  absolute.
  /// @throws InvalidInput when the place is outside of the folder.
  void copy(const std::string& relative, const std::filesystem::path& source);

  /// A new picture, and its name.
  std::string add_picture(const EncodedImage& image);

  /// The new binary file, and its name.
  std::string add_binary(std::string bytes);

  /// Writes all of them.
  /// @throws IoError when a file has other content and is none that the former output named: it may be another scene's.
  ///         Nothing is written then.
  void write() const;

 private:
  std::string add(const std::string& stem, const std::string& extension, std::string bytes);
  /// Whether a file is to be written: there is none of that content. @param former Those that may be replaced.
  bool is_new(const std::string& name, const std::string& bytes, const std::set<std::string>& former) const;

  std::filesystem::path output_;
  std::set<std::string> taken_;                          ///< Names, relative to the output's folder.
  std::map<std::string, std::filesystem::path> copied_;  ///< Their sources, by name.
  std::map<std::string, std::string> added_;             ///< Their content, by name.
};

}  // namespace papilla
