// SPDX-License-Identifier: MIT
#include "placed_bvh.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "papilla/core/bounds.hpp"
#include "papilla/core/cold_arrays.hpp"

namespace papilla::detail {
namespace {

constexpr Index k_leaf_size = 6;

/// A triangle with the box of all of them.
BoxTree::Corners box_of(const PlacedTriangles& part) {
  Bounds3 bounds;
  for (std::size_t t = 0; t < part.size(); ++t)
    for (int k = 0; k < 3; ++k) bounds.add(part.corner(t, k));
  return {bounds.low, bounds.high, bounds.low};
}

}  // namespace

TriangleFrame PlacedBvh::Tree::frame(std::size_t triangle) const noexcept {
  const Vec3 b = part.corner(triangle, 1), c = part.corner(triangle, 2);
  return part.is_mirrored() ? TriangleFrame(part.corner(triangle, 0), c, b)
                            : TriangleFrame(part.corner(triangle, 0), b, c);
}

PlacedBvh::PlacedBvh(const WorldScene& scene) {
  const ColdArrays waiting;
  for (const PlacedTriangles& part : scene.parts) {
    first_.push_back(part.is_opaque() ? static_cast<Index>(size_) : k_no_value);
    if (!part.is_opaque() || part.size() == 0) continue;
    trees_.push_back({part, first_.back(), {}, {}});
    size_ += part.size();
  }
  std::vector<BoxTree::Corners> boxes(trees_.size());
  oneapi::tbb::parallel_for(std::size_t{0}, trees_.size(), [&](std::size_t i) {
    Tree& tree = trees_[i];
    const auto corners_of = [&](std::size_t t) {
      return BoxTree::Corners{tree.part.corner(t, 0), tree.part.corner(t, 1), tree.part.corner(t, 2)};
    };
    const std::size_t count = tree.part.size();
    tree.boxes = BoxTree(count, corners_of, {.leaf_size = k_leaf_size, .extra_boxes = count}, tree.order);
    boxes[i] = box_of(tree.part);
  });
  boxes_ = BoxTree(
      boxes.size(), [&](std::size_t i) { return boxes[i]; }, {.leaf_size = 1}, order_);
}

ClosestPoint PlacedBvh::closest(const Vec3& p) const noexcept {
  ClosestPoint best;
  boxes_.visit_near(p, best.squared_distance, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Tree& tree = trees_[order_[i]];
      tree.boxes.visit_near(p, best.squared_distance, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
          const double d = squared_distance(p, tree.frame(tree.order[k]));
          if (d < best.squared_distance) best = {d, tree.first + tree.order[k]};
        }
        return false;
      });
    }
    return false;
  });
  return best;
}

bool PlacedBvh::blocks(const Vec3& a, const Vec3& b, Index ignored) const noexcept {
  bool blocked = false;
  const Vec3 d = b - a;
  boxes_.visit_cuts(a, b, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !blocked; ++i) {
      const Tree& tree = trees_[order_[i]];
      tree.boxes.visit_cuts(a, b, 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last && !blocked; ++k)
          blocked = tree.first + tree.order[k] != ignored && cut_at(a, d, tree.frame(tree.order[k])) > 0;
        return blocked;
      });
    }
    return blocked;
  });
  return blocked;
}

Index PlacedBvh::first_cut(const Vec3& a, const Vec3& b) const noexcept {
  FirstCut cut;
  const Vec3 d = b - a;
  boxes_.visit_cuts(a, b, cut.at, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Tree& tree = trees_[order_[i]];
      tree.boxes.visit_cuts(a, b, cut.at, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k)
          cut.add(cut_at(a, d, tree.frame(tree.order[k])), tree.first + tree.order[k]);
        return false;
      });
    }
    return false;
  });
  return cut.triangle;
}

TriangleFrame PlacedBvh::frame(Index triangle) const noexcept {
  const auto next = std::upper_bound(trees_.begin(), trees_.end(), triangle,
                                     [](Index number, const Tree& tree) { return number < tree.first; });
  const Tree& tree = *std::prev(next);
  return tree.frame(triangle - tree.first);
}

}  // namespace papilla::detail
