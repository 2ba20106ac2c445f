// SPDX-License-Identifier: MIT
#include "ring_kernel.hpp"

#include <vector>

#include "papilla/core/bounds.hpp"

namespace papilla::param_detail {
namespace {

using Polygon = std::vector<Vec2>;

/// The part of a convex polygon left of the line through a and b.
Polygon clip(const Polygon& polygon, Vec2 a, Vec2 b) {
  Polygon result;
  const Vec2 d = b - a;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double s = cross(d, p - a), t = cross(d, q - a);
    if (s > 0) result.push_back(p);
    if ((s > 0) != (t > 0)) result.push_back(p + (s / (s - t)) * (q - p));
  }
  return result;
}

}  // namespace

bool middle_of_kernel(std::span<const RingEdge> ring, bool closed_by_chord, Vec2& middle) {
  Bounds2 bounds;
  bounds.add(ring.front().from);
  for (const RingEdge& e : ring) bounds.add(e.to);
  const auto [low, high] = bounds;
  Polygon kernel{low, {high.x, low.y}, high, {low.x, high.y}};
  for (const RingEdge& e : ring) kernel = clip(kernel, e.from, e.to);
  if (closed_by_chord) kernel = clip(kernel, ring.back().to, ring.front().from);
  if (kernel.size() < 3) return false;
  middle = {};
  for (const Vec2 p : kernel) middle = middle + (1 / static_cast<double>(kernel.size())) * p;
  return true;
}

}  // namespace papilla::param_detail
