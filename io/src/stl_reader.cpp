// SPDX-License-Identifier: MIT
#include "papilla/io/stl_reader.hpp"

#include <fstream>
#include <string>
#include <string_view>

#include "mesh_file_scene.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/read_file.hpp"
#include "stl_ascii.hpp"
#include "stl_binary.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_head_size = 1024;  ///< Enough to tell text from numbers.

std::string read_head(const std::filesystem::path& path, std::uint64_t size) {
  std::string head(std::min<std::uint64_t>(size, k_head_size), '\0');
  std::ifstream in(path, std::ios::binary);
  if (!in.read(head.data(), static_cast<std::streamsize>(head.size())))
    throw IoError(path.string() + ": cannot be read");
  return head;
}

bool starts_with_solid(std::string_view head) { return equals_ignoring_case(next_word(head), "solid"); }

/// Text has no zero bytes; "solid" may also open a binary header.
bool is_binary(std::string_view head, std::uint64_t size) {
  if (size >= k_stl_header_size && size == k_stl_header_size + k_stl_record_size * stl_declared_triangles(head))
    return true;
  return !starts_with_solid(head) || head.find('\0') != std::string_view::npos;
}

}  // namespace

Scene read_stl(const std::filesystem::path& path, const ReadOptions& options) {
  require_file(path);
  const std::uint64_t size = std::filesystem::file_size(path);
  if (size == 0) throw InvalidInput(path.string() + ": is empty");
  Scene scene = unitless_scene("STL", options, UpAxis::z);
  const double unit = scene.millimetres_per_unit;
  const std::string head = read_head(path, size);
  if (is_binary(head, size))
    scene.parts.push_back(read_binary_stl(path, head, size, unit, scene.warnings));
  else
    scene.parts = read_ascii_stl(read_file(path), path.string(), unit, scene.warnings);
  add_part_nodes(scene, path.stem().string());
  return scene;
}

}  // namespace papilla
