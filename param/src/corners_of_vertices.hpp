// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// The corners (3 t + k) of each vertex.
class CornersOfVertices {
 public:
  CornersOfVertices(std::span<const Triangle> triangles, std::size_t vertices) : first_(vertices + 2, 0) {
    for (const Triangle& t : triangles)
      for (const Index v : t) ++first_[v + 2];
    for (std::size_t v = 2; v < first_.size(); ++v) first_[v] += first_[v - 1];
    corner_.resize(first_.back());
    for (Index t = 0; t < triangles.size(); ++t)
      for (Index k = 0; k < 3; ++k) corner_[first_[triangles[t][k] + 1]++] = 3 * t + k;
  }
  std::span<const Index> of(std::size_t v) const { return {corner_.data() + first_[v], first_[v + 1] - first_[v]}; }

 private:
  std::vector<Index> first_, corner_;
};

}  // namespace papilla::param_detail
