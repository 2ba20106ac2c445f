// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>
#include <utility>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// Disjoint sets over 0 .. size-1; the smallest member represents its set, so results don't depend on the order.
class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  Index find(Index a) noexcept {
    while (parent_[a] != a) {
      parent_[a] = parent_[parent_[a]];
      a = parent_[a];
    }
    return a;
  }

  void unite(Index a, Index b) noexcept {
    a = find(a);
    b = find(b);
    if (a > b) std::swap(a, b);
    parent_[b] = a;
  }

  std::size_t size() const noexcept { return parent_.size(); }

  /// Numbers the sets 0, 1, ... in the order of their smallest members; returns the number of each element.
  std::vector<Index> labels(Index& count) {
    std::vector<Index> label(parent_.size());
    count = 0;
    for (Index a = 0; a < label.size(); ++a) {
      const Index root = find(a);
      label[a] = root == a ? count++ : label[root];
    }
    return label;
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace papilla::detail
