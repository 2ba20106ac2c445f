// SPDX-License-Identifier: MIT
#include <algorithm>

#include "contact_triangle.hpp"

namespace papilla {
namespace {

// Of the tolerance. Coplanar neighbours touch later than the face by ε²/2r, ε the distance to the common edge: the
// times must be finer than that, or the neighbour's tilted normal would be taken.
constexpr double k_close = 1e-7;
constexpr int k_newton_steps = 40;
constexpr int k_march_steps = 512;
constexpr int k_bisections = 24;

}  // namespace

/// How many texels of the relief a way over the triangle crosses.
double ContactSurface::texels_on(std::uint32_t place, const Corners& t, Vec3 way) const noexcept {
  const auto& height = materials_[material_of(place)].height;
  if (!height) return 0;
  const Vec2 weights = weights_of(t, way);
  const auto along = [&](float Relief::*axis) {
    const double u0 = static_cast<double>(relief(place, 0).*axis);
    return weights.x * (static_cast<double>(relief(place, 1).*axis) - u0) +
           weights.y * (static_cast<double>(relief(place, 2).*axis) - u0);
  };
  const std::array<Vec2, 2> per_uv = heights_[*height].texels_per_uv();
  return norm(along(&Relief::u) * per_uv[0] + along(&Relief::v) * per_uv[1]);
}

/// The earlier of two hits; of those at the same place, usually the start, the deeper one: where triangles meet flat,
/// it is the one that x stands above.
bool ContactSurface::comes_before(const SweepHit& a, const SweepHit& b) noexcept {
  return a.t != b.t ? a.t < b.t : a.penetration_m > b.penetration_m;
}

[[gnu::always_inline]] inline void ContactSurface::look(const Corners& t, Vec3 from, Vec3 way, double at,
                                                        Approach& state) noexcept {
  const Vec3 x = from + at * way;
  state.t = at;
  state.d = x - foot(t, x).point;
  state.distance = norm(state.d);
}

/// Goes on from `state` to the first t up to t_max where from + t·way is within `radius` of the triangle. The distance
/// to a convex set is convex on a line, so Newton's steps from outside end at or before the contact: nothing is passed
/// over. @returns false when there is none.
bool ContactSurface::approach(const Corners& t, Vec3 from, Vec3 way, double radius, double t_max,
                              Approach& state) const noexcept {
  const double close = k_close * tolerance_m();
  for (int step = 0; step < k_newton_steps; ++step) {
    if (state.distance <= radius + close) return true;
    const double descent = -dot(state.d, way);
    if (descent <= 0) return false;
    const double way_there = (state.distance - radius) * state.distance;
    if (way_there > (t_max - state.t) * descent) return false;
    look(t, from, way, state.t + way_there / descent, state);
  }
  return true;
}

void ContactSurface::sweep_one(std::uint32_t place, Vec3 from, Vec3 way, double t_max,
                               std::optional<SweepHit>& best) const noexcept {
  if (best) t_max = best->t;
  if (has_relief(place))
    sweep_relief(place, from, way, t_max, best);
  else
    sweep_plain(place, from, way, t_max, best);
}

void ContactSurface::sweep_plain(std::uint32_t place, Vec3 from, Vec3 way, double t_max,
                                 std::optional<SweepHit>& best) const noexcept {
  const Corners t = corners(place);
  const double contact = contact_radius_m();
  Approach touch;
  look(t, from, way, 0, touch);
  if (!approach(t, from, way, contact, t_max, touch)) return;
  Vec3 normal = (1 / touch.distance) * touch.d;
  if (!(touch.distance > 0)) {
    normal = normalized(cross(t.b - t.a, t.c - t.a));
    if (dot(normal, way) > 0) normal = -normal;
  }
  if (dot(normal, way) >= 0) return;
  const SweepHit hit{touch.t, normal, contact - touch.distance, source_[place], material_of(place)};
  if (best && !comes_before(hit, *best)) return;
  if (approach(t, from, way, contact - tolerance_m(), 1, touch)) best = hit;
}

/// Steps over the relief, at most half a texel at a time while it is near, and bisects the step that goes in.
void ContactSurface::sweep_relief(std::uint32_t place, Vec3 from, Vec3 way, double t_max,
                                  std::optional<SweepHit>& best) const noexcept {
  const Corners t = corners(place);
  const double length = norm(way), contact = contact_radius_m(), top = top_of(place);
  Approach entry;
  look(t, from, way, 0, entry);
  if (!approach(t, from, way, contact + top, t_max, entry)) return;
  const double finest = std::max(0.5 / std::max(texels_on(place, t, way), 0.5), 1.0 / k_march_steps);

  // On a hollow every tangent goes in at once: half the tolerance lets the probe get on.
  const double level = -0.5 * tolerance_m();
  double outside = entry.t, at = entry.t, allowed = -tolerance_m();
  for (bool first = true;; first = false) {
    const Vec3 x = from + at * way;
    const Clearance now = clearance_of(place, t, x);
    // A probe that is too deep already may rise.
    if (now.value < allowed && (!first || dot(now.gradient, way) < 0)) break;
    allowed = std::min(-tolerance_m(), now.value);
    if (now.value >= level) outside = at;
    if (at >= t_max) return;
    // Above the highest point and leaving: the rest of the way is free.
    if (now.distance > contact + top && dot(x - foot(t, x).point, way) >= 0) return;
    // Not past the base either: behind it the clearance grows again.
    const double base = std::max(0.5 * now.distance, tolerance_m());
    at = std::min(t_max, at + std::min(std::max(finest, 0.5 * now.value / length), base / length));
  }
  for (int i = 0; i < k_bisections && at - outside > 1e-9; ++i) {
    const double middle = 0.5 * (outside + at);
    (clearance_of(place, t, from + middle * way).value >= level ? outside : at) = middle;
  }
  const Clearance there = clearance_of(place, t, from + outside * way);
  const SweepHit hit{outside, normalized(there.gradient), -there.value, source_[place], material_of(place)};
  if (!best || comes_before(hit, *best)) best = hit;
}

/// The box that a probe sweeps, rounded outwards.
Box3f ContactSurface::way_box_of(Vec3 a, Vec3 b) const noexcept {
  const double size =
      std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z), std::abs(b.x), std::abs(b.y), std::abs(b.z)});
  const double grow = contact_radius_m() + 2 * static_cast<double>(std::numeric_limits<float>::epsilon()) * size;
  const auto low = [grow](double x, double y) { return static_cast<float>(std::min(x, y) - grow); };
  const auto high = [grow](double x, double y) { return static_cast<float>(std::max(x, y) + grow); };
  Box3f box;
  box.low = {low(a.x, b.x), low(a.y, b.y), low(a.z, b.z)};
  box.high = {high(a.x, b.x), high(a.y, b.y), high(a.z, b.z)};
  return box;
}

bool ContactSurface::beside(std::uint32_t place, const Box3f& box) const noexcept {
  const auto& t = triangles_[place];
  const Corner &a = vertices_[t[0]], &b = vertices_[t[1]], &c = vertices_[t[2]];
  bool apart = false;
  for (std::size_t i = 0; i < 3; ++i) {
    apart |= std::max(a[i], std::max(b[i], c[i])) < box.low[i];
    apart |= std::min(a[i], std::min(b[i], c[i])) > box.high[i];
  }
  return apart;
}

std::optional<SweepHit> ContactSurface::sweep(Vec3 from, Vec3 to) const noexcept {
  const Vec3 start = from - origin_, way = to - from;
  std::optional<SweepHit> best;
  double t_max = 1;
  Box3f way_box = way_box_of(start, start + way);
  bvh_.along(start, way, contact_radius_m(), t_max, [&](std::uint32_t begin, std::uint32_t end) noexcept {
    for (std::uint32_t place = begin; place < end; ++place) {
      if (!has_relief(place) && beside(place, way_box)) continue;
      sweep_one(place, start, way, 1, best);
    }
    if (best && best->t < t_max) {
      t_max = best->t;
      way_box = way_box_of(start, start + t_max * way);
    }
  });
  return best;
}

bool ContactSurface::gather(Vec3 centre, double radius_m, Neighbourhood& near) const noexcept {
  near.begin(centre - origin_, radius_m);
  bool fits = true;
  double radius = radius_m + contact_radius_m();
  bvh_.within(centre - origin_, radius, [&](std::uint32_t begin, std::uint32_t end) noexcept {
    fits = fits && !near.full(end - begin);
    if (!fits) radius = 0;  // Ends the walk.
    for (std::uint32_t place = begin; place < end && fits; ++place) {
      const auto& t = triangles_[place];
      near.add(vertices_[t[0]], vertices_[t[1]], vertices_[t[2]], static_cast<float>(top_of(place)), place);
    }
  });
  if (fits)
    near.finish();
  else
    near.clear();
  return fits;
}

/// Looks at the triangles in the order in which they could be met at the earliest, until none can be met before the
/// hit.
std::optional<SweepHit> ContactSurface::sweep(Vec3 from, Vec3 to, const Neighbourhood& near) const noexcept {
  const Vec3 start = from - origin_, way = to - from;
  const double length = norm(way), margin = near.margin(start);
  if (!(margin > 0)) return sweep(from, to);
  const double known = length > margin ? margin / length : 1;
  Neighbourhood::Times earliest;
  near.near_way(start, way, contact_radius_m(), earliest);
  std::array<std::uint32_t, Neighbourhood::k_capacity> open;
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < near.count(); ++i) {
    open[count] = i;
    count += static_cast<double>(earliest[i]) <= known ? 1U : 0U;
  }
  std::optional<SweepHit> best;
  while (count > 0) {
    std::uint32_t next = 0;
    for (std::uint32_t k = 1; k < count; ++k)
      if (earliest[open[k]] < earliest[open[next]]) next = k;
    const std::uint32_t i = open[next];
    if (best && static_cast<double>(earliest[i]) > best->t) break;
    open[next] = open[--count];
    sweep_one(near.place(i), start, way, known, best);
  }
  return best || known >= 1 ? best : sweep(from, to);
}

}  // namespace papilla
