// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace papilla {

/// The values of one vertex attribute as the file stores them, element after element without gaps.
struct GltfAttribute {
  std::string name;
  std::uint32_t accessor = 0;  ///< That describes it.
  std::size_t element_bytes = 0;
  std::vector<std::byte> bytes;
};

/// All that the vertices of a primitive carry.
struct GltfVertices {
  std::size_t count = 0;
  std::vector<GltfAttribute> attributes;
  std::vector<std::vector<GltfAttribute>> targets;  ///< Of its morph targets.
};

/// Reads the vertices of single primitives with every attribute that they have, in the component types of the
/// accessors: sparse accessors become dense, compressed ones (meshopt, Draco) are decoded.
class GltfVertexReader {
 public:
  /// @throws IoError, InvalidInput as read_gltf().
  explicit GltfVertexReader(const std::filesystem::path& file);
  ~GltfVertexReader();

  /// @pre the primitive is one that read_gltf() reads triangles from.
  /// @throws InvalidInput naming file, primitive, attribute and reason.
  GltfVertices read(std::uint32_t mesh, std::uint32_t primitive);

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace papilla
