// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edge_table.hpp"
#include "papilla/core/bounds.hpp"

namespace papilla::detail {

/// A range of `Traversal::order`: triangles connected through edges of exactly two, and what orient() finds out about
/// them.
struct Component {
  std::size_t begin = 0, end = 0;
  std::size_t turned = 0;
  bool closed = true, orientable = true;
  double volume = 0;
  Bounds3 box;
  bool turn_all = false;
};

struct Traversal {
  std::vector<Index> order;        ///< Triangles, component by component.
  std::vector<std::uint8_t> turn;  ///< Per triangle: to agree with the first of its component.
  std::vector<Component> components;
};

/// The other half-edge of edges with exactly two, whichever way they run.
std::vector<Index> neighbours(const EdgeTable& edges, std::size_t triangle_count);

/// Breadth-first through each component, turning each triangle to agree with the one it was reached from.
/// Triangles flagged in `seen` are left out.
Traversal traverse(std::span<const Triangle> triangles, std::span<const Index> neighbour,
                   std::vector<std::uint8_t> seen, std::size_t& conflicts);

}  // namespace papilla::detail
