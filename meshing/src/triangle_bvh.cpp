// SPDX-License-Identifier: MIT
#include "triangle_bvh.hpp"

#include <oneapi/tbb/parallel_for.h>

namespace papilla::detail {
namespace {

constexpr std::size_t k_free_boxes = 1u << 18;  ///< More than these or one a triangle are not added in all.
constexpr std::size_t k_serial_size = 1u << 13;

}  // namespace

TriangleBvh::TriangleBvh(std::span<const Vec3> positions, std::span<const Triangle> triangles)
    : slot_of_(triangles.size()) {
  const auto corners_of = [&](std::size_t i) {
    const Triangle& t = triangles[i];
    return BoxTree::Corners{positions[t[0]], positions[t[1]], positions[t[2]]};
  };
  std::vector<Index> order;
  tree_ = BoxTree(triangles.size(), corners_of, {.extra_boxes = std::max(triangles.size(), k_free_boxes)}, order);
  prims_.resize(order.size());
  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, order.size(), k_serial_size), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const BoxTree::Corners c = corners_of(order[i]);
      prims_[i] = {TriangleFrame(c[0], c[1], c[2]), order[i]};
    }
  });
  for (std::size_t i = order.size(); i-- > 0;) slot_of_[order[i]] = static_cast<Index>(i);
}

ClosestPoint TriangleBvh::closest(const Vec3& p, ClosestPoint best, double enough) const noexcept {
  if (best.squared_distance <= enough) return best;
  tree_.visit_near(p, best.squared_distance, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double d = squared_distance(p, prims_[i].frame);
      if (d < best.squared_distance) best = {d, prims_[i].triangle};
    }
    return best.squared_distance <= enough;
  });
  return best;
}

bool TriangleBvh::blocks(const Vec3& a, const Vec3& b, Index ignored) const noexcept {
  bool blocked = false;
  const Vec3 d = b - a;
  tree_.visit_cuts(a, b, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !blocked; ++i)
      blocked = prims_[i].triangle != ignored && cut_at(a, d, prims_[i].frame) > 0;
    return blocked;
  });
  return blocked;
}

Index TriangleBvh::first_cut(const Vec3& a, const Vec3& b) const noexcept {
  FirstCut first;
  const Vec3 d = b - a;
  tree_.visit_cuts(a, b, first.at, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) first.add(cut_at(a, d, prims_[i].frame), prims_[i].triangle);
    return false;
  });
  return first.triangle;
}

}  // namespace papilla::detail
