// SPDX-License-Identifier: MIT
#include "obj_block.hpp"

#include <fmt/core.h>

#include <cmath>

#include "mesh_file_scene.hpp"
#include "papilla/core/one_line.hpp"
#include "text_scanner.hpp"

namespace papilla::io_detail {
namespace {

/// Statements of the format that carry no triangles.
bool is_unsupported(std::string_view keyword) {
  static const std::set<std::string_view> k_keywords = {
      "p",        "l",    "vp",   "cstype", "deg",    "bmat",   "step",  "curv",  "curv2",      "surf",
      "parm",     "trim", "hole", "scrv",   "sp",     "end",    "con",   "mg",    "bevel",      "c_interp",
      "d_interp", "lod",  "call", "csh",    "maplib", "usemap", "ctech", "stech", "shadow_obj", "trace_obj"};
  return k_keywords.contains(keyword);
}

class ObjBlockParser {
 public:
  explicit ObjBlockParser(std::string_view text) : text_(text) {}

  ObjBlock parse() {
    owner_ = {k_as_before, k_as_before, k_as_before};
    try {
      std::string joined;
      for (std::string_view line = next_line(joined); !at_end_; line = next_line(joined)) parse_line(line);
    } catch (ObjFault& fault) {
      block_.fault = std::move(fault);
    }
    block_.last = owner_;
    return std::move(block_);
  }

 private:
  [[noreturn]] void fail(std::string reason) const { throw ObjFault{block_.lines, std::move(reason)}; }

  void note(ObjOddity& oddity) const {
    if (oddity.count++ == 0) oddity.line = block_.lines;
  }

  std::string_view raw_line() {
    at_end_ = text_.empty();
    if (at_end_) return {};
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    std::string_view line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    ++block_.lines;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  /// A line; a backslash at its end joins the next one.
  std::string_view next_line(std::string& joined) {
    std::string_view line = raw_line();
    if (!line.ends_with('\\')) return line;
    joined.clear();
    for (; line.ends_with('\\') && !text_.empty(); line = raw_line()) {
      joined += line.substr(0, line.size() - 1);
      joined += ' ';
    }
    joined += line;
    return joined;
  }

  void parse_line(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword.empty() || keyword.front() == '#') return;
    if (keyword == "v")
      parse_position(line);
    else if (keyword == "vt")
      parse_uv(line);
    else if (keyword == "vn")
      parse_normal(line);
    else if (keyword == "f" || keyword == "fo")
      parse_face(line);
    else if (keyword == "o")
      owner_.object = block_.content.objects.number(trimmed(line));
    else if (keyword == "g")
      owner_.group = block_.content.groups.number(trimmed(line));
    else if (keyword == "usemtl")
      owner_.material = block_.content.materials.number(trimmed(line));
    else if (keyword == "mtllib")
      block_.content.libraries.push_back({std::string(trimmed(line)), block_.lines});
    else if (is_unsupported(keyword))
      block_.losses.insert(std::string(keyword));
    else if (keyword != "s")
      fail(fmt::format("unknown keyword '{}'", printable(keyword)));
  }

  double number(std::string_view word) const {
    double value = 0;
    if (!parse_number(word, value)) fail(fmt::format("'{}' is not a number", printable(word)));
    return value;
  }

  /// Up to `limit` numbers of a line; returns how many there are.
  std::size_t numbers(std::string_view line, double* values, std::size_t limit) const {
    std::size_t count = 0;
    for (std::string_view word = next_word(line); !word.empty() && word.front() != '#'; word = next_word(line)) {
      if (count == limit) fail(fmt::format("more than {} numbers", limit));
      values[count++] = number(word);
    }
    return count;
  }

  void parse_position(std::string_view line) {
    ObjContent& content = block_.content;
    double n[8] = {};
    const std::size_t count = numbers(line, n, 8);
    if (count < 3) fail(fmt::format("a vertex needs 3 numbers, found {}", count));
    const Vec3 position{n[0], n[1], n[2]};
    if (!is_finite(position)) fail("a vertex is not finite");
    content.positions.push_back(position);
    if (count >= 6) {
      content.colors.resize(content.positions.size() - 1);
      const double* c = n + (count == 6 ? 3 : 4);
      const bool good = std::isfinite(c[0]) && std::isfinite(c[1]) && std::isfinite(c[2]);
      if (!good) note(block_.bad_colors);
      content.colors.push_back(good ? color_from_srgb(c[0], c[1], c[2]) : Color{});
    }
  }

  void parse_uv(std::string_view line) {
    double n[3] = {};
    if (numbers(line, n, 3) < 1) fail("a texture vertex needs numbers");
    const Vec2 uv{n[0], n[1]};
    if (!is_finite(uv)) fail("a texture vertex is not finite");
    block_.content.uv.push_back(uv);
  }

  void parse_normal(std::string_view line) {
    double n[3] = {};
    if (const std::size_t count = numbers(line, n, 3); count != 3)
      fail(fmt::format("a normal needs 3 numbers, found {}", count));
    Vec3 normal{n[0], n[1], n[2]};
    if (!is_finite(normal)) {
      note(block_.bad_normals);
      normal = {};
    }
    block_.content.normals.push_back(normalized(normal));
  }

  /// 1 is the first of the list, −1 the last so far. Indices that point ahead are checked at the end.
  Index resolve(std::string_view text, ObjBackwardIndex::List list) {
    long long index = 0;
    if (!parse_number(text, index)) fail(fmt::format("'{}' is not an index", printable(text)));
    const ObjContent& content = block_.content;
    if (index < 0) {
      const std::size_t length = list == ObjBackwardIndex::List::position ? content.positions.size()
                                 : list == ObjBackwardIndex::List::uv     ? content.uv.size()
                                                                          : content.normals.size();
      block_.backward.push_back({list, content.corners.size(), block_.lines, index, length});
      return 0;
    }
    if (index < 1 || index > static_cast<long long>(k_max_obj_elements))
      fail(fmt::format("{} {} does not exist", name_of(list), printable(text)));
    return static_cast<Index>(index - 1);
  }

  ObjCorner parse_corner(std::string_view word) {
    using List = ObjBackwardIndex::List;
    ObjCorner corner;
    const std::size_t first = std::min(word.find('/'), word.size());
    corner.position = resolve(word.substr(0, first), List::position);
    if (first == word.size()) return corner;
    word.remove_prefix(first + 1);
    const std::size_t second = std::min(word.find('/'), word.size());
    if (second > 0) corner.uv = resolve(word.substr(0, second), List::uv);
    if (second + 1 < word.size()) corner.normal = resolve(word.substr(second + 1), List::normal);
    return corner;
  }

  void parse_face(std::string_view line) {
    ObjContent& content = block_.content;
    const std::size_t first = content.corners.size();
    for (std::string_view word = next_word(line); !word.empty() && word.front() != '#'; word = next_word(line))
      content.corners.push_back(parse_corner(word));
    const std::size_t count = content.corners.size() - first;
    if (count < 3) {
      note(block_.short_faces);
      content.corners.resize(first);
      for (auto back = block_.backward.rbegin(); back != block_.backward.rend() && back->line == block_.lines; ++back)
        back->corner = k_no_corner;
      return;
    }
    content.faces.push_back({first, static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(block_.lines)},
                            owner_);
  }

  std::string_view text_;
  ObjBlock block_;
  bool at_end_ = false;
  ObjOwner owner_;
};

}  // namespace

const char* name_of(ObjBackwardIndex::List list) {
  using List = ObjBackwardIndex::List;
  return list == List::position ? "vertex" : list == List::uv ? "texture vertex" : "normal";
}

ObjBlock parse_obj_block(std::string_view lines) { return ObjBlockParser(lines).parse(); }

}  // namespace papilla::io_detail
