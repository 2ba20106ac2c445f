// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace papilla {

/// Disjoint sets over 0 .. size-1 (union-find with path halving). The smallest member represents its set, so results
/// do not depend on the order of unions. Cost: O(log n) amortized per call.
class UnionFind {
 public:
  explicit UnionFind(std::size_t size = 0) { reset(size); }

  /// Parts all sets into single members again, 0 .. size-1. Keeps the memory.
  void reset(std::size_t size) {
    parent_.resize(size);
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }

  std::uint32_t find(std::uint32_t a) noexcept {
    while (parent_[a] != a) {
      parent_[a] = parent_[parent_[a]];
      a = parent_[a];
    }
    return a;
  }

  void unite(std::uint32_t a, std::uint32_t b) noexcept {
    a = find(a);
    b = find(b);
    if (a > b) std::swap(a, b);
    parent_[b] = a;
  }

  std::size_t size() const noexcept { return parent_.size(); }

  /// Numbers the sets 0, 1, ... in the order of their smallest members; returns the number of each element.
  std::vector<std::uint32_t> labels(std::uint32_t& count) {
    std::vector<std::uint32_t> label(parent_.size());
    count = 0;
    for (std::uint32_t a = 0; a < label.size(); ++a) {
      const std::uint32_t root = find(a);
      label[a] = root == a ? count++ : label[root];
    }
    return label;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace papilla
