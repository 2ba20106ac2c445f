// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// A static k-d tree over some of a mesh's positions, for "which points lie near this segment or point".
/// Building costs O(n log n); a query visits O(log n) nodes plus those near its answer, however unevenly
/// the points are spread, which a uniform grid can't promise.
class PointTree {
 public:
  /// `members` are indices into `positions`.
  PointTree(std::span<const Vec3> positions, const std::vector<Index>& members);

  /// Calls visit(index, position) for a superset of the members within `radius` of the segment a-b.
  template <class Visit>
  void near_segment(const Vec3& a, const Vec3& b, double radius, const Visit& visit) const {
    if (!nodes_.empty()) descend(0, a, b - a, radius, visit);
  }

  /// Calls visit(index, position) for a superset of the members within `radius` of p.
  template <class Visit>
  void near_point(const Vec3& p, double radius, const Visit& visit) const {
    near_segment(p, p, radius, visit);
  }

 private:
  struct Node {
    Vec3 low, high;
    Index begin = 0, end = 0;
    Index right = 0;  ///< Second child; the first follows its parent. 0: a leaf.
  };

  static bool touches(const Node& node, const Vec3& a, const Vec3& d, double radius) noexcept {
    double enter = 0, leave = 1;
    return clip(a.x, d.x, node.low.x - radius, node.high.x + radius, enter, leave) &&
           clip(a.y, d.y, node.low.y - radius, node.high.y + radius, enter, leave) &&
           clip(a.z, d.z, node.low.z - radius, node.high.z + radius, enter, leave);
  }

  static bool clip(double a, double d, double low, double high, double& enter, double& leave) noexcept {
    if (std::abs(d) < std::numeric_limits<double>::min()) return a >= low && a <= high;
    const double inverse = 1 / d;
    double t0 = (low - a) * inverse, t1 = (high - a) * inverse;
    if (t0 > t1) std::swap(t0, t1);
    enter = std::max(enter, t0);
    leave = std::min(leave, t1);
    return enter <= leave;
  }

  template <class Visit>
  void descend(Index node_index, const Vec3& a, const Vec3& d, double radius, const Visit& visit) const {
    const Node& node = nodes_[node_index];
    if (!touches(node, a, d, radius)) return;
    if (node.right == 0) {
      for (Index i = node.begin; i < node.end; ++i) visit(members_[i].index, members_[i].position);
      return;
    }
    descend(node_index + 1, a, d, radius, visit);
    descend(node.right, a, d, radius, visit);
  }

  struct Member {
    Vec3 position;
    Index index;
  };

  Index build(Index begin, Index end);

  std::vector<Member> members_;  ///< In the order of the leaves.
  std::vector<Node> nodes_;
};

}  // namespace papilla::detail
