// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "papilla/core/vec.hpp"

namespace papilla::detail {

/// A box along the axes; empty until something is added.
struct Bounds {
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 high = -low;

  void add(const Vec3& p) noexcept {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }

  /// Length of the diagonal; 0 when nothing was added.
  double diagonal() const noexcept { return low.x <= high.x ? norm(high - low) : 0; }

  bool overlaps(const Bounds& other, double margin) const noexcept {
    return low.x - margin <= other.high.x && low.y - margin <= other.high.y && low.z - margin <= other.high.z &&
           high.x + margin >= other.low.x && high.y + margin >= other.low.y && high.z + margin >= other.low.z;
  }

  /// True when `other` lies within, by more than `margin` on every side.
  bool contains(const Bounds& other, double margin = 0) const noexcept {
    return low.x + margin < other.low.x && low.y + margin < other.low.y && low.z + margin < other.low.z &&
           high.x - margin > other.high.x && high.y - margin > other.high.y && high.z - margin > other.high.z;
  }
};

}  // namespace papilla::detail
