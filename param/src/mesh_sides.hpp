// SPDX-License-Identifier: MIT
#pragma once

#include <tuple>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// One side of a triangle, named by the points it joins: the lower position first.
struct Side {
  Index part;
  Index low, high;        ///< Positions.
  Index uv_low, uv_high;  ///< uv at these.
  Index corner;           ///< 3 * triangle + corner where the side starts.
  auto edge() const { return std::tie(part, low, high); }
  auto uv_edge() const { return std::tie(part, low, high, uv_low, uv_high); }
};

/// All sides, those of one edge side by side, within it those of equal uv. Equal positions and equal uv get one number.
/// @param part of each triangle: edges of different parts are different; empty: one part.
std::vector<Side> sorted_sides(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                               const std::vector<std::uint32_t>& part);

/// Calls visit(first, last) for every run of sides that are equal by `key`.
template <class Key, class Visit>
void each_run(const std::vector<Side>& sides, Key key, Visit visit) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && key(sides[end]) == key(sides[begin])) ++end;
    visit(begin, end);
    begin = end;
  }
}

}  // namespace papilla::param_detail
