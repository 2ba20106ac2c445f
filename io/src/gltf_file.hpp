// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "gltf_side_files.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// A glTF file as it is: its JSON, to be edited, and its binary data, to which more can be added.
///
/// Into a GLB, buffers and pictures in files of their own and all buffers of a .gltf file are moved, the bytes of each
/// as they were. A .gltf gets copies of the files that a .gltf names, at the same places below its folder, and a new
/// binary file for what is added, or for the binary chunk of a GLB with what is added; new pictures are files.
class GltfFile {
 public:
  using Json = nlohmann::ordered_json;
  static constexpr int k_vertices = 34962, k_indices = 34963;  ///< bufferView.target

  /// @throws IoError when a file can't be read; InvalidInput when it is no glTF or a buffer is missing.
  GltfFile(const std::filesystem::path& path, const std::filesystem::path& output);

  Json json;

  /// The JSON as it was.
  const Json& original() const noexcept { return original_; }

  /// Adds bytes, aligned to 4, and returns the number of their bufferView; equal bytes are stored once.
  std::size_t add_view(std::string_view bytes, int target = 0, std::size_t stride = 0);

  /// Adds a picture and returns its number; the same one is stored once.
  std::size_t add_picture(const EncodedImage& image);

  /// Appends an entry to a list of the document, unless there is an equal one, and returns its number.
  std::size_t add(const char* list, Json entry);

  /// KHR_animation_pointer: what moves an entry of a list moves a copy of it, too.
  void copy_animations(const char* list, std::size_t original, std::size_t copy);

  /// The name in the lists of extensions, when it is new.
  void use_extension(const char* name);

  /// Takes the name out of the lists of extensions.
  void forget_extension(const char* name);

  /// Chunks of a GLB that glTF does not define, which a .gltf has no place for.
  bool drops_chunks() const noexcept { return files_ && !further_chunks_.empty(); }

  /// @throws InvalidInput when a GLB exceeds 4 GiB; IoError when writing fails, or as GltfSideFiles::write().
  void write();

 private:
  void read_binary(const std::string& bytes);
  void embed_buffers(bool all);
  void embed_images();
  void keep_files();
  void note_pictures();
  std::string_view view_bytes(std::size_t number) const;
  std::string buffer_bytes(std::size_t number) const;

  std::filesystem::path path_, output_;
  std::optional<GltfSideFiles> files_;  ///< Of a .gltf.
  Json original_;
  std::string binary_, further_chunks_;
  std::size_t data_buffer_ = 0;                                        ///< The number of the buffer of `binary_`.
  std::size_t original_size_ = 0;                                      ///< Of the binary data.
  std::map<std::string, std::map<std::string, std::size_t>> entries_;  ///< By list and JSON, of lists with additions.
  std::multimap<std::size_t, std::size_t> views_;                      ///< Those added, by the hash of their bytes.
  std::multimap<std::size_t, std::size_t> pictures_;  ///< All whose bytes are at hand, by the hash of these.
};

}  // namespace papilla
