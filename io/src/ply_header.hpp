// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace papilla {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t ply_size(PlyType type) noexcept;
bool is_integer(PlyType type) noexcept;

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< Of a list.
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> texture_files;  ///< Of MeshLab's "comment TextureFile NAME".
  std::size_t size = 0;                    ///< Bytes up to the first element.
};

/// Reads the header and holds its counts against the bytes that follow it.
/// @param file  what messages call it.
/// @throws InvalidInput naming file, line and reason.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& file);

}  // namespace papilla
