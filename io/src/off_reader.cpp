// SPDX-License-Identifier: MIT
// A parser of our own: CGAL 5.5 and OpenMesh 9 take the memory that the counts claim, and OpenMesh runs for minutes on
// a polygon that claims four billion corners.
#include "papilla/io/mesh_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_file_scene.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "polygon_mesh.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

static_assert(std::endian::native == std::endian::little, "binary OFF has the other byte order");

/// Attributes of the vertices and the encoding, by the keyword.
struct OffKind {
  bool normals = false, colors = false, uv = false, binary = false;
};

/// The numbers of a file in order. In text a colour is the rest of the line, of any length.
class OffSource {
 public:
  OffSource(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  [[noreturn]] void fail(const std::string& reason) const {
    const std::string_view before = bytes_.substr(0, at_);
    const std::string place = binary_ ? fmt::format("byte {}", at_)
                                      : fmt::format("line {}", std::count(before.begin(), before.end(), '\n') + 1);
    throw InvalidInput(fmt::format("{}: {}: {}", file_, place, reason));
  }

  OffKind read_keyword() {
    OffKind kind;
    const std::size_t begin = at_;
    std::string_view word = this->word();
    if (word.find_first_not_of("+-.0123456789eE") == std::string_view::npos) {  // The first number.
      at_ = begin;
      return kind;
    }
    const std::string keyword(word);
    const auto take = [&](std::string_view prefix) {
      const bool found = word.starts_with(prefix);
      if (found) word.remove_prefix(prefix.size());
      return found;
    };
    kind.uv = take("ST");
    kind.colors = take("C");
    kind.normals = take("N");
    if (word != "OFF") fail("is no OFF file of points in space: it begins with '" + printable(keyword) + "'");
    const std::size_t behind = at_;
    if (this->word() == "BINARY") {
      kind.binary = binary_ = true;
      at_ = std::min(bytes_.find('\n', at_), bytes_.size() - 1) + 1;
    } else {
      at_ = behind;
    }
    return kind;
  }

  std::size_t count(const char* what) {
    double value = 0;
    if (binary_) {
      value = binary<std::int32_t>();
    } else {
      const std::string_view text = word();
      if (!parse_number(text, value)) fail(fmt::format("'{}' is not a number of {}", printable(text), what));
    }
    if (!(value >= 0 && value < k_no_value) || value != std::floor(value))
      fail(fmt::format("{} is not a number of {}", value, what));
    return static_cast<std::size_t>(value);
  }

  double real() {
    if (binary_) return binary<float>();
    const std::string_view text = word();
    double value = 0;
    if (text.empty()) fail("truncated: a number expected");
    if (!parse_number(text, value)) fail("'" + printable(text) + "' is not a number");
    return value;
  }

  /// A colour of `size` parts in [0, 1]. In text those without decimal point or exponent are integers up to 255.
  void color(std::array<double, 4>& parts, std::size_t size) {
    const std::size_t begin = at_;
    for (std::size_t i = 0; i < size; ++i) parts[i] = real();
    if (binary_ || bytes_.substr(begin, at_ - begin).find_first_of(".eE") != std::string_view::npos) return;
    for (double& part : parts) part /= 255;
  }

  /// How many numbers the rest of the line holds; more than a colour and texture coordinates count as 7.
  std::size_t numbers_on_line() {
    const std::size_t begin = at_;
    std::size_t count = 0;
    while (count < 7 && !word_of_line().empty()) ++count;
    at_ = begin;
    return count;
  }

  void end_line() {
    if (!binary_) at_ = std::min(bytes_.find('\n', at_), bytes_.size());
  }

  /// Refuses counts that the bytes left could not hold. A number of text takes two bytes, its white space included.
  void require(std::size_t elements, std::size_t numbers, const char* what) const {
    const std::size_t size = numbers * (binary_ ? 4U : 2U), left = bytes_.size() - at_ + (binary_ ? 0U : 1U);
    if (size > 0 && elements > left / size)
      fail(fmt::format("truncated: {} {} promised, {} bytes found", elements, what, left));
  }

 private:
  /// Skips white space and comments, up to the line's end or beyond it.
  void skip_blank(bool over_lines) {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#')
        at_ = std::min(bytes_.find('\n', at_), bytes_.size());
      else if (is_space(bytes_[at_]) && (over_lines || bytes_[at_] != '\n'))
        ++at_;
      else
        return;
    }
  }

  std::string_view take_word() {
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_space(bytes_[at_]) && bytes_[at_] != '#') ++at_;
    return bytes_.substr(begin, at_ - begin);
  }

  std::string_view word() {
    skip_blank(true);
    return take_word();
  }

  std::string_view word_of_line() {
    skip_blank(false);
    return take_word();
  }

  template <class T>
  T binary() {
    std::array<char, 4> raw;
    if (bytes_.size() - at_ < raw.size()) fail("truncated: a number of 4 bytes expected");
    std::reverse_copy(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
                      bytes_.begin() + static_cast<std::ptrdiff_t>(at_ + raw.size()), raw.begin());
    at_ += raw.size();
    return std::bit_cast<T>(raw);
  }

  std::string_view bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
  bool binary_ = false;
};

class OffReader {
 public:
  OffReader(std::string_view bytes, const std::string& file, double unit, Scene& scene)
      : source_(bytes, file), unit_(unit), scene_(scene) {}

  Part read() {
    kind_ = source_.read_keyword();
    const std::size_t vertices = source_.count("vertices"), faces = source_.count("faces");
    if (kind_.binary)
      source_.count("edges");
    else
      source_.end_line();  // The number of edges is often missing and not needed.
    read_vertices(vertices);
    read_faces(faces);
    note_oddities();
    Part part;
    part.mesh = mesh_.finish();
    return part;
  }

 private:
  Vec3 vec3() {
    Vec3 v;
    v.x = source_.real();
    v.y = source_.real();
    v.z = source_.real();
    return v;
  }

  template <class Vec>
  Vec finite_or_zero(Vec value) {
    if (is_finite(value)) return value;
    ++bad_values_;
    return {};
  }

  Color color_of(const std::array<double, 4>& parts, std::size_t size) {
    const double alpha = size == 4 ? parts[3] : 1;
    if (!std::isfinite(parts[0] + parts[1] + parts[2] + alpha)) {
      ++bad_values_;
      return {};
    }
    return color_from_srgb(parts[0], parts[1], parts[2], alpha);
  }

  void read_vertices(std::size_t count) {
    const std::size_t least = 3U + (kind_.normals ? 3U : 0U) + (kind_.colors ? 3U : 0U) + (kind_.uv ? 2U : 0U);
    source_.require(count, least, "vertices");
    mesh_.positions.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      mesh_.positions.push_back(unit_ * vec3());
      if (!is_finite(mesh_.positions.back())) source_.fail(fmt::format("vertex {} is not finite", i));
      if (kind_.normals) mesh_.normals.push_back(normalized(finite_or_zero(vec3())));
      if (kind_.colors) mesh_.colors.push_back(vertex_color());
      if (kind_.uv) {
        Vec2 uv;
        uv.x = source_.real();
        uv.y = source_.real();
        mesh_.uv.push_back(finite_or_zero(uv));
      }
    }
  }

  /// Three or four numbers: in text as many as the line holds before the texture coordinates, in binary four.
  Color vertex_color() {
    const std::size_t behind = kind_.uv ? 2U : 0U;
    const std::size_t size = kind_.binary || source_.numbers_on_line() != 3 + behind ? 4 : 3;
    std::array<double, 4> parts{};
    source_.color(parts, size);
    return color_of(parts, size);
  }

  void read_faces(std::size_t count) {
    source_.require(count, kind_.binary ? 2 : 1, "faces");
    std::vector<Index> corners;
    for (std::size_t f = 0; f < count; ++f) {
      const std::size_t size = source_.count("corners");
      source_.require(size, 1, "corners");
      corners.clear();
      for (std::size_t k = 0; k < size; ++k) {
        const std::size_t corner = source_.count("a vertex");
        if (corner >= mesh_.positions.size())
          source_.fail(fmt::format("vertex {} of {} does not exist", corner, mesh_.positions.size()));
        corners.push_back(static_cast<Index>(corner));
      }
      add_face(corners);
    }
  }

  void add_face(const std::vector<Index>& corners) {
    std::array<double, 4> parts{};
    const std::size_t size = kind_.binary ? source_.count("colour components") : source_.numbers_on_line();
    if (size > 4) source_.fail(fmt::format("a colour of {} numbers", size));
    source_.color(parts, size);
    map_numbers_ += size == 1 || size == 2;
    PolygonMesh::Polygon polygon{corners, {}, {}, 0};
    if (size >= 3) polygon.color = color_of(parts, size);
    try {
      mesh_.add(polygon);
    } catch (const InvalidInput& error) {
      source_.fail(error.what());
    }
  }

  void note_oddities() {
    if (map_numbers_ > 0) scene_.losses.push_back(fmt::format("{} faces' numbers of a colour map", map_numbers_));
    if (mesh_.short_polygons() > 0)
      scene_.warnings.push_back(
          fmt::format("{} faces of fewer than three corners are ignored", mesh_.short_polygons()));
    if (bad_values_ > 0)
      scene_.warnings.push_back(
          fmt::format("{} normals, colours or texture coordinates are not finite and are ignored", bad_values_));
  }

  OffSource source_;
  double unit_;
  Scene& scene_;
  OffKind kind_;
  PolygonMesh mesh_;
  std::size_t map_numbers_ = 0, bad_values_ = 0;
};

}  // namespace

Scene read_off(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string file = path.string();
  Scene scene = unitless_scene("OFF", options, UpAxis::z);
  const std::string bytes = read_file(path);
  if (bytes.empty()) throw InvalidInput(file + ": is empty");
  scene.parts.push_back(OffReader(bytes, file, scene.millimetres_per_unit, scene).read());
  add_part_nodes(scene, path.stem().string());
  return scene;
}

}  // namespace papilla
