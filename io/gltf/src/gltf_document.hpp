// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace papilla::gltf {

/// A parsed file: everything but the accessors' content, which tinygltf does not check.
struct Document {
  std::string file;  ///< As messages name it.
  bool binary = false;
  tinygltf::Model model;
  std::set<int> empty_buffers;  ///< Those without data, as extensions allow them.
  std::vector<std::string> warnings;
};

/// Reads and parses; pictures stay encoded in Image::image (those in buffer views stay there).
/// @throws IoError, InvalidInput as read_gltf().
Document load_document(const std::filesystem::path& path);

}  // namespace papilla::gltf
