// SPDX-License-Identifier: MIT
#include "point_tree.hpp"

#include <span>

#include "papilla/core/bounds.hpp"

namespace papilla::detail {
namespace {

constexpr Index k_leaf_size = 8;

double coordinate(const Vec3& p, int axis) noexcept { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

}  // namespace

PointTree::PointTree(std::span<const Vec3> positions, const std::vector<Index>& members) {
  if (members.empty()) return;
  members_.reserve(members.size());
  for (const Index v : members) members_.push_back({positions[v], v});
  nodes_.reserve(members.size() / 2 + 4);
  build(0, static_cast<Index>(members_.size()));
}

Index PointTree::build(Index begin, Index end) {
  const Index index = static_cast<Index>(nodes_.size());
  Bounds3 bounds;
  for (Index i = begin; i < end; ++i) bounds.add(members_[i].position);
  nodes_.push_back({bounds.low, bounds.high, begin, end, 0});
  if (end - begin <= k_leaf_size) return index;

  const Vec3 size = bounds.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const Index middle = begin + (end - begin) / 2;
  const auto at = [&](Index i) { return members_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [axis](const Member& a, const Member& b) {
    return std::pair(coordinate(a.position, axis), a.index) < std::pair(coordinate(b.position, axis), b.index);
  });
  build(begin, middle);
  const Index right = build(middle, end);
  nodes_[index].right = right;
  return index;
}

}  // namespace papilla::detail
