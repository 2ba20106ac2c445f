// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace papilla::gltf {

/// Attributes and sizes that a primitive expects of its compressed data.
struct DracoRequest {
  std::map<int, int> components;  ///< By the attribute's unique id: numbers an element has.
  std::size_t max_points = 0, max_triangles = 0;
};

/// A decoded mesh; every attribute has points elements.
struct DracoMesh {
  struct Attribute {
    std::vector<double> numbers;
    bool is_integer = false;  ///< Integers that are not normalized yet.
  };
  std::size_t points = 0;
  std::vector<std::uint32_t> corners;  ///< Three per triangle, below points.
  std::map<int, Attribute> attributes;
};

/// Whether this build can decode Draco.
bool has_draco() noexcept;

/// Decodes KHR_draco_mesh_compression. The counts that the stream claims are checked before libdraco may take memory
/// for them.
/// @param where  begins messages.
/// @throws InvalidInput when the stream is damaged, holds more than the request allows or lacks an attribute, or this
///         build has no libdraco.
DracoMesh decode_draco(std::span<const unsigned char> bytes, const DracoRequest& request, const std::string& where);

}  // namespace papilla::gltf
