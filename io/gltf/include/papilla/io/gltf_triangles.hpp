// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// What a primitive draws, in single precision as glTF stores it: metres in the frame of the mesh, v downwards.
struct GltfPrimitive {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 3>> normals;  ///< One per position, of any length; or empty.
  std::vector<std::array<float, 2>> uv;       ///< One per position; or empty.
  std::vector<Triangle> triangles;
};

/// A glTF file whose triangles are read one primitive at a time, for those who turn them into something else at once.
/// Memory: the file, the primitive that is being read, and nothing more for each triangle.
class GltfTriangles {
 public:
  /// @param tags  as GltfReadOptions::tags.
  /// @throws IoError, InvalidInput as read_gltf(); what concerns the content of primitives is thrown by read().
  explicit GltfTriangles(const std::filesystem::path& path, const std::filesystem::path& tags = {});
  ~GltfTriangles();
  GltfTriangles(GltfTriangles&&) noexcept;

  /// As read_gltf() makes it, but for the meshes, which are empty. Tags keep their texture channels.
  Scene scene;

  /// A primitive that draws triangles.
  struct Primitive {
    std::uint32_t number = 0;       ///< Within its mesh.
    std::uint32_t slot = 0;         ///< Of Part::materials.
    std::size_t most_vertices = 0;  ///< As the file promises; not checked yet.
    std::size_t most_triangles = 0;
  };
  /// The primitives of a part.
  std::vector<Primitive> primitives(std::uint32_t part) const;

  /// @param channel of the texture coordinates; nothing: without. @param normals with them, if there are any.
  /// @throws InvalidInput as read_gltf().
  GltfPrimitive read(std::uint32_t part, const Primitive& primitive, std::optional<int> channel, bool normals);

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace papilla
