// SPDX-License-Identifier: MIT
#include "stl_ascii.hpp"

#include <algorithm>

#include "papilla/core/error.hpp"
#include "papilla/io/vertex_welder.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

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

std::vector<Part> read_ascii_stl(std::string_view text, const std::string& file, double unit,
                                 std::vector<std::string>& warnings) {
  return AsciiReader(text, file, unit).read(warnings);
}

}  // namespace papilla
