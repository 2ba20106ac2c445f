// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// A tree of boxes over numbered triangles, four boxes a node, single precision around the triangles' centre and
/// rounded outwards by more than the search's own rounding. A triangle may lie in several boxes: a slanted sliver in a
/// row of them. The triangles themselves are the owner's. Building costs O(n log n) by the surface area heuristic, in
/// parallel, and about 100 bytes a box meanwhile; the tree itself 32 bytes a box with 2 in a leaf, 18 with 6. Same
/// input, same tree, whatever the number of threads.
class BoxTree {
 public:
  using Corners = std::array<Vec3, 3>;
  struct Options {
    Index leaf_size = 2;          ///< Boxes in a leaf, 1 to 7.
    std::size_t extra_boxes = 0;  ///< Beyond one a triangle, in all.
  };

  BoxTree() = default;
  /// @param corners_of  of the triangles 0 ... count - 1, finite; called from several threads.
  /// @param order  becomes the triangle in each box; leaves are ranges of it.
  BoxTree(std::size_t count, const std::function<Corners(std::size_t)>& corners_of, const Options& options,
          std::vector<Index>& order);

  bool empty() const noexcept { return nodes_.empty(); }

  /// Goes to the leaves nearest first, to those that may hold something nearer than `best`.
  /// @param best  squared distance; leaf(begin, end) may lower it, and ends the search by returning true.
  template <class Leaf>
  void visit_near(const Vec3& p, const double& best, const Leaf& leaf) const;

  /// Goes to the leaves whose boxes meet a + t (b - a), 0 <= t <= end.
  /// @param end  may fall meanwhile; leaf(begin, end) ends the search by returning true.
  template <class Leaf>
  void visit_cuts(const Vec3& a, const Vec3& b, const double& end, const Leaf& leaf) const;

 private:
  /// Children >= 0 are nodes, others leaves of ~child: first box in the upper bits, count in the lower three.
  struct alignas(64) Node {
    float low[3][4], high[3][4];
    std::int64_t child[4];
  };
  friend class BoxTreeBuilder;

  static constexpr int k_sah_depth = 40;  ///< Deeper levels split in the middle, so that the depth stays below 40 + 32.
  static constexpr std::size_t k_stack = 3 * 72 + 4;  ///< A node leaves at most three children behind.

  Vec3 centre_;
  std::vector<Node> nodes_;
};

template <class Leaf>
void BoxTree::visit_near(const Vec3& p, const double& best, const Leaf& leaf) const {
  if (nodes_.empty()) return;
  struct Entry {
    float distance;
    std::int64_t child;
  };
  Entry stack[k_stack];
  std::size_t depth = 0;
  const Vec3 relative = p - centre_;
  const float q[3] = {static_cast<float>(relative.x), static_cast<float>(relative.y), static_cast<float>(relative.z)};
  /// Far from the list the search loses less than this fraction of a squared distance.
  constexpr double k_slack = static_cast<double>(1e-5f);
  auto limit = static_cast<float>(best * (1 + k_slack));

  stack[depth++] = {0, 0};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.distance > limit) continue;
    if (entry.child < 0) {
      const auto bits = static_cast<std::size_t>(~entry.child);
      if (leaf(bits >> 3, (bits >> 3) + (bits & 7))) return;
      limit = static_cast<float>(best * (1 + k_slack));
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(entry.child)];
    float d[4] = {0, 0, 0, 0};
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 4; ++i) {
        const float below = node.low[k][i] - q[k], above = q[k] - node.high[k][i];
        const float larger = below > above ? below : above;
        const float outside = larger > 0 ? larger : 0;
        d[i] += outside * outside;
      }
    const std::size_t first = depth;
    for (int i = 0; i < 4; ++i) {
      if (!(d[i] <= limit)) continue;
      std::size_t place = depth++;
      for (; place > first && stack[place - 1].distance < d[i]; --place) stack[place] = stack[place - 1];
      stack[place] = {d[i], node.child[i]};
    }
  }
}

template <class Leaf>
void BoxTree::visit_cuts(const Vec3& a, const Vec3& b, const double& end, const Leaf& leaf) const {
  if (nodes_.empty()) return;
  const Vec3 d = b - a;
  const Vec3 start = a - centre_;
  const double origin[3] = {start.x, start.y, start.z};
  // A zero component becomes a huge slope, which the slab test below handles like an infinite one without NaN.
  const auto slope = [](double x) { return std::abs(x) > 1e-300 ? 1 / x : std::copysign(1e300, x); };
  const double inverse[3] = {slope(d.x), slope(d.y), slope(d.z)};

  std::int64_t stack[k_stack];
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::int64_t child = stack[--depth];
    if (child < 0) {
      const auto bits = static_cast<std::size_t>(~child);
      if (leaf(bits >> 3, (bits >> 3) + (bits & 7))) return;
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(child)];
    for (int i = 0; i < 4; ++i) {
      double enter = 0, leave = end;
      for (int k = 0; k < 3; ++k) {
        const double t0 = (static_cast<double>(node.low[k][i]) - origin[k]) * inverse[k];
        const double t1 = (static_cast<double>(node.high[k][i]) - origin[k]) * inverse[k];
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
      }
      // The relative slack covers the rounding of the slab products.
      if (enter <= leave * (1 + 1e-12) + 1e-15) stack[depth++] = node.child[i];
    }
  }
}

}  // namespace papilla::detail
