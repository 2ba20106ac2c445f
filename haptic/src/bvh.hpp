// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "large_array.hpp"
#include "papilla/core/vec.hpp"

namespace papilla {

/// An axis-aligned box in single precision.
struct Box3f {
  std::array<float, 3> low{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::infinity()};
  std::array<float, 3> high{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()};
  void add(const Box3f& other) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], other.low[i]);
      high[i] = std::max(high[i], other.high[i]);
    }
  }
};

/// A box and the number of what it encloses.
struct BoxedItem {
  Box3f box;
  std::uint32_t item = 0;
};

/// Bounding volume hierarchy over boxes, as one flat array of 32-byte nodes.
///
/// Built top down with the surface area heuristic over 16 bins per axis [Wald 2007, "On fast construction of SAH-based
/// bounding volume hierarchies"]; below depth 48, and where all centres coincide, by halving, which bounds the depth by
/// k_stack. Build: O(n log n), three passes over the items of each level, in memory order; needs no memory but that of
/// the items and the nodes. The first two levels of many items are split between up to four threads; the tree is the
/// same for any number of them. Queries are noexcept, use a fixed stack and allocate nothing. They report ranges of the
/// items, which the owner keeps in the order of the build.
class Bvh {
 public:
  Bvh() = default;
  /// @param items with finite boxes, at most 2³¹; sorted by leaves. @param leaf_size most items in a leaf, ≥ 1.
  explicit Bvh(std::span<BoxedItem> items, std::uint32_t leaf_size = 4);

  /// Numbers the leaves in the order of the items; queries then call visit(number, number + 1).
  /// @returns the first place of each leaf, and the end of the last.
  std::vector<std::uint32_t> number_leaves();
  bool empty() const noexcept { return nodes_.empty(); }
  std::size_t bytes() const noexcept { return nodes_.size() * sizeof(Node); }

  /// Calls visit(begin, end) for each leaf with a point nearer than `radius` to `centre`, in order of distance.
  /// `visit` may shrink `radius`.
  template <class Visit>
  void within(Vec3 centre, double& radius, Visit&& visit) const noexcept {
    walk([&](const Node& node) noexcept { return distance2(node.box, centre); },
         [&](double key) noexcept { return key <= radius * radius; }, visit);
  }

  /// Calls visit(begin, end) for each leaf that comes nearer than `radius` to the points from + t·along,
  /// t ∈ [0, t_max], in order of entry. `visit` may shrink `t_max`. (Boxes are grown by `radius`, so some leaves are
  /// visited in vain at their corners.)
  template <class Visit>
  void along(Vec3 from, Vec3 along, double radius, double& t_max, Visit&& visit) const noexcept {
    const Slabs slabs(from, along, radius);
    walk([&](const Node& node) noexcept { return slabs.entry(node.box, t_max); },
         [&](double key) noexcept { return key <= t_max; }, visit);
  }

 private:
  struct Node {
    Box3f box;
    std::uint32_t first = 0;  ///< Leaf: place of its first box; else: index of the first of two children.
    std::uint32_t count = 0;  ///< Leaf: number of boxes; else 0.
  };
  struct Build;
  static constexpr int k_stack = 96;
  static constexpr std::uint32_t k_root = 1;  // So that siblings share a cache line.

  struct Slabs {
    double origin[3], inverse[3], radius;
    Slabs(Vec3 from, Vec3 direction, double r) noexcept : origin{from.x, from.y, from.z}, radius(r) {
      const double d[3] = {direction.x, direction.y, direction.z};
      // A finite replacement of 1/0: 0 · ∞ would be NaN.
      for (int i = 0; i < 3; ++i) inverse[i] = std::abs(d[i]) > 1e-290 ? 1 / d[i] : std::copysign(1e290, d[i]);
    }
    /// Parameter at which the ray enters the grown box; infinity when that is not before t_max.
    double entry(const Box3f& box, double t_max) const noexcept {
      double in = 0, out = t_max;
      for (std::size_t i = 0; i < 3; ++i) {
        const double a = (static_cast<double>(box.low[i]) - radius - origin[i]) * inverse[i];
        const double b = (static_cast<double>(box.high[i]) + radius - origin[i]) * inverse[i];
        in = std::max(in, std::min(a, b));
        out = std::min(out, std::max(a, b));
      }
      return in <= out ? in : std::numeric_limits<double>::infinity();
    }
  };

  static double distance2(const Box3f& box, Vec3 p) noexcept {
    const double q[3] = {p.x, p.y, p.z};
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double d = std::max({static_cast<double>(box.low[i]) - q[i], q[i] - static_cast<double>(box.high[i]), 0.0});
      sum += d * d;
    }
    return sum;
  }

  /// Depth first, the child with the smaller key first; `wanted` is evaluated again when an entry is popped.
  template <class Key, class Wanted, class Visit>
  void walk(Key&& key, Wanted&& wanted, Visit&& visit) const noexcept {
    if (nodes_.empty()) return;
    struct Entry {
      double key;
      std::uint32_t node;
    };
    Entry stack[k_stack];
    int size = 0;
    Entry now{key(nodes_[k_root]), k_root};
    for (;;) {
      if (wanted(now.key)) {
        const Node& node = nodes_[now.node];
        if (node.count == 0) {
          Entry near{key(nodes_[node.first]), node.first}, far{key(nodes_[node.first + 1]), node.first + 1};
          if (far.key < near.key) std::swap(near, far);
          if (wanted(far.key)) stack[size++] = far;
          now = near;
          continue;
        }
        visit(node.first, node.first + node.count);
      }
      if (size == 0) return;
      now = stack[--size];
    }
  }

  LargeArray<Node> nodes_;
  std::uint32_t items_ = 0;
};

}  // namespace papilla
