// SPDX-License-Identifier: MIT
#include "ring_placement.hpp"

#include <algorithm>
#include <vector>

#include "papilla/core/bounds.hpp"
#include "vertex_step.hpp"

namespace papilla::param_detail {
namespace {

constexpr int k_steps = 20;

/// Steps end when the vertex moves by less than this fraction of an edge of its ring.
constexpr double k_small_move = 0.01;

/// How much larger or smaller than its rest shape a triangle may be taken when the apex is guessed from it.
constexpr double k_most_scale = 2;

/// A corner that is nearer to the vertex than this fraction of the edge between the others tells where it goes.
constexpr double k_near = 0.1;

struct Guess {
  Vec2 apex;
  double weight;
};

/// Where the triangle's own shape puts the vertex. Edges that are short for their distance say little about it, a
/// corner that is close to it says much.
Guess guess(const RingEdge& e) {
  const double base = e.rest.base(), along = e.rest.along(), height = e.rest.height();
  const Vec2 rest_edge{along - base, height};  // from the second to the third corner; the vertex is at the origin
  const double length = std::sqrt(dot(rest_edge, rest_edge)), uv_length = std::sqrt(dot(e.to - e.from, e.to - e.from));
  if (!(length > 0) || !(uv_length > 0)) return {e.from, 0};
  const Vec2 x = (1 / length) * rest_edge, to_apex{-base, 0};
  const double scale = std::clamp(uv_length / length, 1 / k_most_scale, k_most_scale);
  const double s = dot(to_apex, x), t = cross(x, to_apex);
  const Vec2 d = (1 / uv_length) * (e.to - e.from);
  // Measured from the nearer end, so that a turned or stretched edge matters as little as possible.
  const bool from_start = s < 0.5 * length;
  const double offset = from_start ? s : s - length;
  const Vec2 apex = (from_start ? e.from : e.to) + (scale * offset) * d + (scale * t) * Vec2{-d.y, d.x};
  const double far = std::sqrt(along * along + height * height), trust = length * length / (base * far);
  const double nearness = std::max(1.0, k_near * length / std::min(base, far));
  return {apex, e.rest.area * trust * trust * nearness * nearness};
}

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

/// The middle of all places that see every edge of the ring from the left.
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

bool all_positive(std::span<const RingEdge> ring, Vec2 at) {
  return std::all_of(ring.begin(), ring.end(), [&](const RingEdge& e) { return cross(e.from - at, e.to - at) > 0; });
}

}  // namespace

bool place_in_ring(std::span<const RingEdge> ring, const std::function<bool(Vec2)>& allowed, Vec2& place) {
  const auto good = [&](Vec2 p) { return all_positive(ring, p) && (!allowed || allowed(p)); };
  double weight = 0;
  place = {};
  for (const RingEdge& e : ring) {
    const Guess g = guess(e);
    weight += g.weight, place = place + g.weight * g.apex;
  }
  if (weight > 0) place = (1 / weight) * place;
  if (!(weight > 0) || !good(place)) {
    if (!(middle_of_kernel(ring, false, place) && good(place)) && !(middle_of_kernel(ring, true, place) && good(place)))
      return false;
  }
  const Vec2 edge = ring.front().to - ring.front().from;
  std::vector<CornerView> views;
  for (int i = 0; i < k_steps; ++i) {
    views.clear();
    for (const RingEdge& e : ring) views.push_back(corner_view(e.rest, 0, e.from - place, e.to - place));
    const Vec2 step = corner_step(views);
    if (allowed && !allowed(place + step)) break;
    place = place + step;
    if (dot(step, step) < k_small_move * k_small_move * dot(edge, edge)) break;
  }
  return true;
}

}  // namespace papilla::param_detail
