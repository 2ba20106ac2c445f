// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace papilla {

/// A glTF file as it is: its JSON, to be edited, and its binary data, to which more can be added.
///
/// Whatever the input, the output is one GLB: buffers and pictures in files of their own, and all buffers of a .gltf
/// file, are moved into the binary chunk, the bytes of each as they were.
class GltfFile {
 public:
  using Json = nlohmann::ordered_json;
  static constexpr int k_vertices = 34962, k_indices = 34963;  ///< bufferView.target

  /// @throws IoError when a file can't be read; InvalidInput when it is no glTF or a buffer is missing.
  explicit GltfFile(const std::filesystem::path& path);

  Json json;

  /// The JSON as it was.
  const Json& original() const noexcept { return original_; }

  /// Adds bytes, aligned to 4, and returns the number of their bufferView; equal bytes are stored once.
  std::size_t add_view(std::string_view bytes, int target = 0, std::size_t stride = 0);

  /// Appends an entry to a list of the document, unless there is an equal one, and returns its number.
  std::size_t add(const char* list, Json entry);

  /// The name in the lists of extensions, when it is new.
  void use_extension(const char* name);

  /// Takes the name out of the lists of extensions.
  void forget_extension(const char* name);

  /// @throws InvalidInput when the file exceeds 4 GiB; IoError when writing fails.
  void write(const std::filesystem::path& path);

 private:
  void read_binary(const std::string& bytes);
  void embed_buffers(bool all);
  void embed_images();
  void note_view(std::size_t number);
  std::string buffer_bytes(std::size_t number) const;

  std::filesystem::path path_;
  Json original_;
  std::string binary_, further_chunks_;
  std::size_t original_size_ = 0;                                      ///< Of the binary data.
  std::map<std::string, std::map<std::string, std::size_t>> entries_;  ///< By list and JSON, of lists with additions.
  std::multimap<std::size_t, std::size_t> views_;  ///< Those added and those of pictures, by the hash of their bytes.
};

}  // namespace papilla
