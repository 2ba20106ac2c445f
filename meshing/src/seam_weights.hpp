// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "segmented_mesh.hpp"

namespace papilla::detail {

/// The share of directions in which each triangle is open to the outside: rays against the surface from up to 2,048
/// places, over which every other triangle takes the nearest one's.
std::vector<float> triangle_openness(const SegmentedMesh& surface);

/// 1 for triangles whose middle an eye sees past the others, k_least_openness for all that are hidden from it.
std::vector<float> openness_to(const SegmentedMesh& surface, const Vec3& eye);

/// How much a seam shows along each edge: w = o (1 - s), with o the share of directions in which the edge is open to
/// the outside, from k_least_openness up, and s = 1/2 on creases of the feature angle and sharper, 3/4 when they are
/// concave, and proportionally less on flatter ones.
class SeamWeights {
 public:
  /// @param openness  triangle_openness() of the surface, or openness_to() an eye.
  SeamWeights(const SegmentedMesh& surface, const std::vector<float>& openness, double feature_angle_deg);

  /// Weights of 1.
  explicit SeamWeights(const SegmentedMesh& surface) : surface_(surface), weight_(surface.opposite.size(), 1) {}

  double of(Index halfedge) const noexcept { return double{weight_[halfedge]}; }
  /// Length times weight.
  double cost(Index halfedge) const noexcept { return of(halfedge) * surface_.length(halfedge); }

 private:
  const SegmentedMesh& surface_;
  std::vector<float> weight_;
};

}  // namespace papilla::detail
