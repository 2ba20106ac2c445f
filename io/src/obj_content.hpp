// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::io_detail {

constexpr Index k_no_index = std::numeric_limits<Index>::max();
constexpr std::size_t k_max_obj_elements = k_no_index - 1;

/// A face's corner: numbers into the file's lists, from 0, k_no_index when not given.
struct ObjCorner {
  Index position = k_no_index, uv = k_no_index, normal = k_no_index;
};

/// The corners of faces, one list a number; those of uv and normals end with the last that is given.
class ObjCornerList {
 public:
  std::size_t size() const noexcept { return position_.size(); }
  void reserve(std::size_t corners) { position_.reserve(corners); }

  void push_back(const ObjCorner& corner) {
    position_.push_back(corner.position);
    add(uv_, corner.uv);
    add(normal_, corner.normal);
  }
  void append(const ObjCornerList& more) {
    const std::size_t before = size();
    position_.insert(position_.end(), more.position_.begin(), more.position_.end());
    append(uv_, more.uv_, before);
    append(normal_, more.normal_, before);
  }
  void resize(std::size_t size) {
    for (std::vector<Index>* list : {&position_, &uv_, &normal_}) list->resize(std::min(list->size(), size));
  }
  ObjCorner operator[](std::size_t i) const noexcept {
    return {position_[i], i < uv_.size() ? uv_[i] : k_no_index, i < normal_.size() ? normal_[i] : k_no_index};
  }
  Index& position(std::size_t i) noexcept { return position_[i]; }
  Index& uv(std::size_t i) noexcept { return uv_[i]; }
  Index& normal(std::size_t i) noexcept { return normal_[i]; }

  /// Whether all numbers that are given are of lists of these lengths.
  bool are_within(std::size_t positions, std::size_t uv, std::size_t normals) const noexcept {
    return are_below(position_, positions) && are_below(uv_, uv) && are_below(normal_, normals);
  }

 private:
  void add(std::vector<Index>& list, Index number) const {
    if (number == k_no_index) return;
    list.resize(position_.size() - 1, k_no_index);
    list.push_back(number);
  }
  static void append(std::vector<Index>& list, const std::vector<Index>& more, std::size_t before) {
    if (more.empty()) return;
    list.resize(before, k_no_index);
    list.insert(list.end(), more.begin(), more.end());
  }
  static bool are_below(const std::vector<Index>& list, std::size_t length) noexcept {
    Index most = 0;  // Of the number and one: that of k_no_index is 0.
    for (const Index number : list) most = std::max(most, number + 1);
    return most <= length;
  }

  std::vector<Index> position_, uv_, normal_;
};

struct ObjFace {
  std::size_t first_corner;
  std::uint32_t corners, line;
};

/// What a face belongs to: numbers of names.
struct ObjOwner {
  std::uint32_t object = 0, group = 0, material = 0;
  bool operator==(const ObjOwner&) const = default;
};

/// Faces one after the other that belong together.
struct ObjRun {
  std::size_t first_face, faces, first_corner;
  ObjOwner owner;
};

/// The faces of a file in 8 bytes each.
class ObjFaceList {
 public:
  void reserve(std::size_t faces) { sizes_.reserve(faces); }

  void push_back(const ObjFace& face, const ObjOwner& owner) {
    if (runs_.empty() || runs_.back().owner != owner) runs_.push_back({sizes_.size(), 0, face.first_corner, owner});
    ++runs_.back().faces;
    sizes_.push_back({face.corners, face.line});
  }
  const std::vector<ObjRun>& runs() const noexcept { return runs_; }

  /// Calls do_face(face) for those of a run.
  template <class DoFace>
  void each(const ObjRun& run, const DoFace& do_face) const {
    std::size_t corner = run.first_corner;
    for (std::size_t f = run.first_face; f < run.first_face + run.faces; ++f) {
      do_face(ObjFace{corner, sizes_[f].corners, sizes_[f].line});
      corner += sizes_[f].corners;
    }
  }

 private:
  struct Size {
    std::uint32_t corners, line;
  };
  std::vector<Size> sizes_;
  std::vector<ObjRun> runs_;
};

/// A name's number in the order of first use.
class ObjNames {
 public:
  std::uint32_t number(std::string_view name) {
    const auto [entry, is_new] = numbers_.try_emplace(std::string(name), static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back(entry->first);
    return entry->second;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
};

/// A mtllib statement.
struct ObjLibrary {
  std::string names;
  std::size_t line;
};

/// The content of the lines, from which parts are assembled.
struct ObjContent {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uv;
  std::vector<Color> colors;  ///< As many as positions up to the last that has one, or none.
  ObjCornerList corners;
  ObjFaceList faces;
  ObjNames objects, groups, materials;
  std::vector<ObjLibrary> libraries;
};

/// Reads the lines of a file, blocks of them at once; the same for any number of threads. What is odd or left out is
/// noted in the scene.
/// @param file  names it in messages.
/// @throws InvalidInput naming file, line and reason: the first of the file, or else that it holds no vertices, or else
/// the first index of nothing.
ObjContent read_obj_content(std::string_view text, const std::string& file, Scene& scene);

}  // namespace papilla::io_detail
