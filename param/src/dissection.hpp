// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// Groups of unknowns that the terms of a quadratic form couple: element e has vertices[first[e]] to
/// vertices[first[e + 1]].
struct Elements {
  std::vector<Index> first{0}, vertices;
  std::size_t count() const { return first.size() - 1; }
  std::span<const Index> of(std::size_t e) const { return {vertices.data() + first[e], first[e + 1] - first[e]}; }
  void add(std::span<const Index> members) {
    vertices.insert(vertices.end(), members.begin(), members.end());
    first.push_back(static_cast<Index>(vertices.size()));
  }
};

Elements elements_of(std::span<const Triangle> triangles);

/// A front of the elimination: its own unknowns are eliminated together, `rows` are those that are coupled to them
/// and come later.
struct Front {
  Index begin = 0, end = 0;        ///< Own unknowns, in elimination order.
  std::vector<Index> rows;         ///< Elimination numbers, ascending.
  std::vector<Index> into_parent;  ///< Place of each row in the parent's list (own unknowns, then rows).
  std::vector<Index> elements;     ///< Elements that are summed here: those whose first unknown is eliminated here.
  Index parent = ~Index{0}, left = ~Index{0}, right = ~Index{0};
  std::size_t subtree_work = 0;  ///< Multiplications in this front and below, about.
  Index own() const { return end - begin; }
  Index size() const { return own() + static_cast<Index>(rows.size()); }
};

inline constexpr Index k_no_front = ~Index{0};

/// Nested dissection: an elimination order with little fill, and the structure of the factor.
struct Dissection {
  std::vector<Index> order;     ///< order[new] = old.
  std::vector<Index> position;  ///< position[old] = new.
  std::vector<Front> fronts;    ///< Children before parents; the last one is the root.
};

/// Splits the unknowns at the median of a coordinate, or at the median distance in edges where that cuts less, again
/// and again. Large halves are split in parallel; the result does not depend on the number of threads. O(n log n).
/// @param where one point per unknown, near for unknowns that are coupled.
/// @param leaf stop splitting at so many unknowns.
Dissection dissect(const Elements& elements, std::span<const Vec3> where, Index leaf);

/// Works on all fronts, in parallel and in no order.
void for_each_front(std::span<const Front> fronts, const std::function<void(Index front)>& work);

}  // namespace papilla::param_detail
