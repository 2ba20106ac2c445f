// SPDX-License-Identifier: MIT
#include "papilla/io/stl_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "mesh_file_scene.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/read_file.hpp"
#include "papilla/io/vertex_welder.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read in place");

constexpr std::size_t k_header_size = 84, k_record_size = 50, k_normal_size = 12;

[[noreturn]] void fail(const std::string& file, const std::string& reason) { throw InvalidInput(file + ": " + reason); }

bool equals_ignoring_case(std::string_view text, std::string_view lower) {
  if (text.size() != lower.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if ((text[i] >= 'A' && text[i] <= 'Z' ? text[i] + 32 : text[i]) != lower[i]) return false;
  return true;
}

std::uint64_t declared_triangles(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

bool starts_with_solid(std::string_view bytes) {
  std::string_view head = bytes.substr(0, 256);
  return equals_ignoring_case(next_word(head), "solid");
}

/// Text has no zero bytes; "solid" may also open a binary header.
bool is_binary(std::string_view bytes) {
  if (bytes.size() >= k_header_size && bytes.size() == k_header_size + k_record_size * declared_triangles(bytes))
    return true;
  return !starts_with_solid(bytes) || bytes.substr(0, 1024).find('\0') != std::string_view::npos;
}

Part read_binary(std::string_view bytes, const std::string& file, double unit, std::vector<std::string>& warnings) {
  if (bytes.size() < k_header_size)
    fail(file, "truncated: an STL header has 84 bytes, the file " + std::to_string(bytes.size()));
  const std::uint64_t count = declared_triangles(bytes);
  const std::uint64_t present = (bytes.size() - k_header_size) / k_record_size;
  if (present < count)
    fail(file, "truncated: " + std::to_string(count) + " triangles promised, " + std::to_string(present) + " found");
  if (const std::size_t surplus = bytes.size() - k_header_size - k_record_size * count; surplus > 0)
    warnings.push_back(std::to_string(surplus) + " bytes behind the last triangle are ignored");

  Part part;
  VertexWelder welder(count / 2);
  part.mesh.triangles.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 9> numbers{};
    std::memcpy(numbers.data(), bytes.data() + k_header_size + k_record_size * t + k_normal_size, sizeof numbers);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 point{double{numbers[3 * k]}, double{numbers[3 * k + 1]}, double{numbers[3 * k + 2]}};
      if (!is_finite(point)) fail(file, "triangle " + std::to_string(t) + ": a coordinate is not finite");
      part.mesh.triangles[t][k] = welder.add(unit * point);
    }
  }
  part.mesh.positions = welder.take_points();
  return part;
}

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
  void read_facet(VertexWelder& welder, std::vector<Triangle>& triangles) {
    expect("normal");
    for (int i = 0; i < 3; ++i) next();  // Some writers put NaN or words here; the winding tells the side.
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

}  // namespace

Scene read_stl(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  if (bytes.empty()) fail(file, "is empty");
  const double unit = options.millimetres_per_unit;
  Scene scene = unitless_scene("STL", options, UpAxis::z);
  if (is_binary(bytes))
    scene.parts.push_back(read_binary(bytes, file, unit, scene.warnings));
  else
    scene.parts = AsciiReader(bytes, file, unit).read(scene.warnings);
  add_part_nodes(scene, path.stem().string());
  return scene;
}

}  // namespace papilla
