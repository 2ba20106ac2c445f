// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_file_scene.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/io/vertex_welder.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_stl_header_size = 84, k_stl_record_size = 50;

static_assert(std::endian::native == std::endian::little, "binary STL is read in place");

constexpr std::size_t k_normal_size = 12, k_color_at = 48;
constexpr std::size_t k_block = 1024;  ///< Triangles read at once: 50 kB, which stay in the second-level cache.

/// The two bytes behind each triangle as a colour. Both conventions use 5 bits a channel.
/// Source: https://en.wikipedia.org/wiki/STL_(file_format)#Color_in_binary_STL
class AttributeColors {
 public:
  /// Materialise's header holds "COLOR=" and the object's colour as four bytes.
  explicit AttributeColors(std::string_view head) {
    const std::size_t at = head.substr(0, 80).find("COLOR=");
    if (at == std::string_view::npos || at + 10 > 80) return;
    is_materialise_ = true;
    for (std::size_t i = 0; i < 4; ++i) object_[i] = static_cast<std::uint8_t>(head[at + 6 + i]);
  }

  void add(std::size_t triangle, std::uint16_t code) {
    if (codes_.empty()) {
      if (!has_color(code)) return;
      codes_.resize(triangle, is_materialise_ ? k_valid : 0);
    }
    codes_.push_back(code);
  }

  /// Triangles without a colour of their own get the object's, or white.
  CornerAttribute<Color> colors() const {
    CornerAttribute<Color> result;
    if (codes_.empty()) return result;
    std::vector<Index> number_of_code(std::size_t{1} << 16, k_no_value);
    result.indices.reserve(codes_.size());
    for (const std::uint16_t code : codes_) {
      Index& number = number_of_code[code];
      if (number == k_no_value) {
        number = static_cast<Index>(result.values.size());
        result.values.push_back(color_of(code));
      }
      result.indices.push_back({number, number, number});
    }
    return result;
  }

 private:
  static constexpr std::uint16_t k_valid = 0x8000;

  /// VisCAM sets the top bit of triangles with a colour, Materialise of those without.
  bool has_color(std::uint16_t code) const { return ((code & k_valid) != 0) != is_materialise_; }

  Color color_of(std::uint16_t code) const {
    const auto channel = [&](int shift) { return (code >> shift & 31) / 31.0; };
    if (has_color(code) && is_materialise_) return color_from_srgb(channel(0), channel(5), channel(10));
    if (has_color(code)) return color_from_srgb(channel(10), channel(5), channel(0));
    Color color = color_from_srgb(object_[0] / 255.0, object_[1] / 255.0, object_[2] / 255.0);
    color.a = static_cast<float>(object_[3]) / 255;
    return color;
  }

  bool is_materialise_ = false;
  std::array<std::uint8_t, 4> object_{255, 255, 255, 255};
  std::vector<std::uint16_t> codes_;  ///< Empty while no triangle had a colour.
};

/// Unpacks records and welds their corners.
class BlockReader {
 public:
  BlockReader(std::string_view head, std::uint64_t triangles, double unit, const std::string& file)
      : file_(file), unit_(unit), welder_(triangles / 2), colors_(head) {
    mesh_.triangles.resize(triangles);
    corners_.reserve(3 * k_block);
    numbers_.resize(3 * k_block);
  }

  void add(std::string_view records) {
    corners_.clear();
    const std::size_t count = records.size() / k_stl_record_size;
    for (std::size_t i = 0; i < count; ++i) unpack(records.data() + k_stl_record_size * i, done_ + i);
    welder_.add(corners_, std::span(numbers_).first(corners_.size()));
    std::memcpy(mesh_.triangles.data() + done_, numbers_.data(), count * sizeof(Triangle));
    done_ += count;
  }

  TriangleMesh finish() {
    mesh_.positions = welder_.take_points();
    mesh_.colors = colors_.colors();
    return std::move(mesh_);
  }

 private:
  void unpack(const char* record, std::size_t triangle) {
    std::array<float, 9> numbers;
    std::memcpy(numbers.data(), record + k_normal_size, sizeof numbers);
    for (std::size_t k = 0; k < 9; k += 3) {
      const Vec3 point{double{numbers[k]}, double{numbers[k + 1]}, double{numbers[k + 2]}};
      if (!is_finite(point))
        throw InvalidInput(file_ + ": triangle " + std::to_string(triangle) + ": a coordinate is not finite");
      corners_.push_back(unit_ * point);
    }
    std::uint16_t code;
    std::memcpy(&code, record + k_color_at, sizeof code);
    colors_.add(triangle, code);
  }

  const std::string& file_;
  double unit_;
  TriangleMesh mesh_;
  VertexWelder welder_;
  AttributeColors colors_;
  std::vector<Vec3> corners_;
  std::vector<Index> numbers_;
  std::size_t done_ = 0;
};

/// The number of triangles that a binary STL's first 84 bytes promise.
std::uint64_t stl_declared_triangles(std::string_view head) {
  std::uint32_t count = 0;
  std::memcpy(&count, head.data() + 80, sizeof count);
  return count;
}

/// Reads a binary STL in blocks, so that the file is never in memory as a whole.
/// @param head  the file's first bytes, at least the header when the file is that long.
/// @param size  of the file.
/// @throws IoError, InvalidInput as read_stl().
Part read_binary_stl(const std::filesystem::path& path, std::string_view head, std::uint64_t size, double unit,
                     std::vector<std::string>& warnings) {
  const std::string file = path.string();
  if (size < k_stl_header_size)
    throw InvalidInput(file + ": truncated: an STL header has 84 bytes, the file " + std::to_string(size));
  const std::uint64_t count = stl_declared_triangles(head);
  const std::uint64_t present = (size - k_stl_header_size) / k_stl_record_size;
  if (present < count)
    throw InvalidInput(file + ": truncated: " + std::to_string(count) + " triangles promised, " +
                       std::to_string(present) + " found");
  if (const std::uint64_t surplus = size - k_stl_header_size - k_stl_record_size * count; surplus > 0)
    warnings.push_back(std::to_string(surplus) + " bytes behind the last triangle are ignored");

  BlockReader reader(head, count, unit, file);
  std::ifstream in(path, std::ios::binary);
  in.seekg(k_stl_header_size);
  std::string block(k_block * k_stl_record_size, '\0');
  for (std::uint64_t left = count; left > 0;) {
    const std::size_t bytes = std::min<std::uint64_t>(left, k_block) * k_stl_record_size;
    if (!in.read(block.data(), static_cast<std::streamsize>(bytes))) throw IoError(file + ": cannot be read");
    reader.add(std::string_view(block).substr(0, bytes));
    left -= bytes / k_stl_record_size;
  }
  Part part;
  part.mesh = reader.finish();
  return part;
}

[[noreturn]] void fail(const std::string& file, const std::string& reason) { throw InvalidInput(file + ": " + reason); }

/// Reads the grammar of ASCII STL word by word.
class AsciiReader {
 public:
  AsciiReader(std::string_view text, const std::string& file, double unit) : text_(text), file_(file), unit_(unit) {}

  std::vector<Part> read(std::vector<std::string>& warnings) {
    std::vector<Part> parts;
    for (std::string_view word = next(); !word.empty(); word = next()) {
      if (!equals_ignoring_case(word, "solid")) fail_at("'solid' expected, found '" + printable(word) + "'");
      parts.push_back(read_solid());
    }
    if (large_facets_ > 0) warnings.push_back(std::to_string(large_facets_) + " facets have more than three vertices");
    return parts;
  }

 private:
  [[noreturn]] void fail_at(const std::string& reason) const {
    fail(file_, "line " + std::to_string(line_) + ": " + reason);
  }

  std::string_view next() {
    std::size_t begin = 0;
    for (; begin < text_.size() && is_space(text_[begin]); ++begin) line_ += text_[begin] == '\n';
    text_.remove_prefix(begin);
    return next_word(text_);
  }

  std::string_view rest_of_line() {
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    const std::string_view rest = trimmed(text_.substr(0, end));
    text_.remove_prefix(end);
    return rest;
  }

  void expect(std::string_view keyword) { expect(next(), keyword); }

  void expect(std::string_view word, std::string_view keyword) const {
    if (word.empty())
      fail(file_, "truncated in triangle " + std::to_string(triangles_) + ": '" + std::string(keyword) +
                      "' expected at the end of the file");
    if (!equals_ignoring_case(word, keyword))
      fail_at("'" + std::string(keyword) + "' expected, found '" + printable(word) + "'");
  }

  double number() {
    const std::string_view word = next();
    double value = 0;
    if (word.empty()) fail(file_, "truncated in triangle " + std::to_string(triangles_) + ": a number expected");
    if (!parse_number(word, value)) fail_at("'" + printable(word) + "' is not a number");
    return value;
  }

  Part read_solid() {
    Part part;
    part.name = std::string(rest_of_line());
    VertexWelder welder;
    std::string_view word = next();
    for (; equals_ignoring_case(word, "facet"); word = next()) read_facet(welder, part.mesh.triangles);
    if (word.empty()) fail(file_, "truncated after triangle " + std::to_string(triangles_) + ": 'endsolid' expected");
    if (!equals_ignoring_case(word, "endsolid"))
      fail_at("'facet' or 'endsolid' expected, found '" + printable(word) + "'");
    rest_of_line();
    part.mesh.positions = welder.take_points();
    return part;
  }

  Vec3 read_vertex() {
    Vec3 vertex;
    vertex.x = number();
    vertex.y = number();
    vertex.z = number();
    if (!is_finite(vertex)) fail_at("triangle " + std::to_string(triangles_) + ": a coordinate is not finite");
    return unit_ * vertex;
  }

  /// Appends a facet. One with more than three vertices, which STL forbids, is read as a fan.
  void read_facet(VertexWelder& welder, Values<Triangle>& triangles) {
    expect("normal");
    for (int i = 0; i < 3; ++i) next();  // Some writers store NaN or words here; the winding decides the side.
    expect("outer");
    expect("loop");
    Triangle triangle{};
    for (Index& corner : triangle) {
      expect("vertex");
      corner = welder.add(read_vertex());
    }
    triangles.push_back(triangle);
    ++triangles_;
    std::string_view word = next();
    large_facets_ += equals_ignoring_case(word, "vertex");
    for (; equals_ignoring_case(word, "vertex"); word = next()) {
      const Index corner = welder.add(read_vertex());
      if (corner == triangle[2] || corner == triangle[0]) continue;
      triangle = {triangle[0], triangle[2], corner};
      triangles.push_back(triangle);
      ++triangles_;
    }
    expect(word, "endloop");
    expect("endfacet");
  }

  std::string_view text_;
  const std::string& file_;
  double unit_;
  std::size_t line_ = 1, triangles_ = 0, large_facets_ = 0;
};

/// The solids of an ASCII STL, one part each.
/// @param file  what messages call it.
/// @throws InvalidInput as read_stl().
std::vector<Part> read_ascii_stl(std::string_view text, const std::string& file, double unit,
                                 std::vector<std::string>& warnings) {
  return AsciiReader(text, file, unit).read(warnings);
}

constexpr std::size_t k_head_size = 1024;  ///< Enough to distinguish text from numbers.

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
