// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "seam_state.hpp"

namespace papilla::param_detail {

/// Half-edges that leave each vertex, without those of borders. O(n).
class OutgoingEdges {
 public:
  explicit OutgoingEdges(const SeamMesh& mesh) : first_(mesh.on_border.size() + 1, 0) {
    const auto each = [&](auto visit) {
      for (Index h = 0; h < mesh.opposite.size(); ++h)
        if (mesh.opposite[h] != k_no_triangle) visit(h);
    };
    each([&](Index h) { ++first_[mesh.from(h) + 1]; });
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    out_.resize(first_.back());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    each([&](Index h) { out_[next[mesh.from(h)]++] = h; });
  }

  std::span<const Index> of(Index v) const { return {out_.data() + first_[v], first_[v + 1] - first_[v]}; }

 private:
  std::vector<Index> first_, out_;
};

}  // namespace papilla::param_detail
