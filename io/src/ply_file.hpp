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

/// MeshLab's "comment TextureFile NAME".
struct PlyTextureFile {
  std::string name;
  std::size_t line;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<PlyTextureFile> texture_files;
  std::size_t size = 0;  ///< Bytes up to the first element.
};

/// Reads the header and checks its counts against the bytes that follow it.
/// @param file  what messages call it.
/// @throws InvalidInput naming file, line and reason.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& file);

/// The numbers behind a PLY header, in order. No more memory is allocated than the remaining bytes can fill.
class PlyBody {
 public:
  /// @param bytes  the whole file.
  PlyBody(std::string_view bytes, const PlyHeader& header, const std::string& file)
      : bytes_(bytes), format_(header.format), at_(header.size), file_(file) {}

  /// @throws InvalidInput naming the line or byte, as everything here, when the file ends or holds no number.
  double number(PlyType type);

  /// A list's numbers.
  void list(const PlyProperty& property, std::vector<double>& values);

  void skip(const PlyElement& element);

  std::size_t position() const noexcept { return at_; }
  void go_to(std::size_t position) noexcept { at_ = position; }

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  std::size_t list_length(const PlyProperty& property);

  std::string_view bytes_;
  PlyFormat format_;
  std::size_t at_;
  const std::string& file_;
};

}  // namespace papilla
