// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "obj_content.hpp"

namespace papilla::io_detail {

/// In the owner of a block's faces: what held at its beginning.
constexpr std::uint32_t k_as_before = k_no_index;

/// Of a face that is ignored.
constexpr std::size_t k_no_corner = static_cast<std::size_t>(-1);

/// An index that counts back from the last element so far: its place among all is known with the blocks before.
struct ObjBackwardIndex {
  enum class List { position, uv, normal } list;
  std::size_t corner, line;
  std::int64_t said;     ///< Below 0.
  std::size_t of_block;  ///< How many elements of the list the block had there.
};

/// What messages call an element of the list.
const char* name_of(ObjBackwardIndex::List list);

/// How often something unusual was found, and the first line.
struct ObjOddity {
  std::size_t count = 0, line = 0;
};

struct ObjFault {
  std::size_t line;
  std::string reason;
};

/// What some whole lines of a file say by themselves. Lines count from 1 within the block, and so do the names' numbers
/// from 0; indices that count forward are those of the file.
struct ObjBlock {
  ObjContent content;
  std::vector<ObjBackwardIndex> backward;
  ObjOwner last;  ///< What holds at its end.
  std::size_t lines = 0;
  ObjOddity short_faces, bad_normals, bad_colors;
  std::set<std::string> losses;   ///< Keywords of statements that carry no triangles.
  std::optional<ObjFault> fault;  ///< The first; nothing behind it is read.
};

ObjBlock parse_obj_block(std::string_view lines);

}  // namespace papilla::io_detail
