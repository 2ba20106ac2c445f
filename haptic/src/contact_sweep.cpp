// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>

#include "contact_sweep.hpp"

namespace papilla {
namespace {

// Accuracy of a contact, of the tolerance. A coplanar neighbour is touched later than the face by ε²/2r, ε the distance
// to the common edge: contacts must be resolved finer, or the neighbour's tilted normal would be taken.
constexpr double k_close = 1e-7;
constexpr double k_crease = 0.25;   // Of the tolerance: distance within which a second face is a crease.
constexpr double k_short_way = 16;  // Skins; also the growth of the pieces of a long segment.
constexpr int k_newton_steps = 40;  // Bound; convergence is quadratic.

}  // namespace

/// Conservative advancement from `state` to the first t up to t_max where from + t·way is within `radius` of the
/// triangle. The distance to a convex set is convex along a line, so a Newton step from outside ends at or before the
/// contact, and the tangent proves early that t = 1 is not within `least`.
/// @returns false when there is no such t, or when the distance never falls below `least`.
bool ContactTriangles::advance(const Corners& t, Vec3 from, Vec3 way, double radius, double least, double t_max,
                               Approach& state) const noexcept {
  const double close = k_close * tolerance_m();
  for (int step = 0; step < k_newton_steps; ++step) {
    if (state.distance <= radius + close) return true;
    const double descent = -dot(state.d, way);
    if (descent <= 0) return false;
    const double way_there = (state.distance - radius) * state.distance;
    if (way_there > (t_max - state.t) * descent) return false;
    if ((state.distance - least - close) * state.distance > (1 - state.t) * descent) return false;
    move_approach(t, from, way, state.t + way_there / descent, state);
  }
  return true;
}

/// Whether the segment from `state` comes within `least` of the triangle. The distance to the closest point of the
/// start is an upper bound and decides most often.
bool ContactTriangles::comes_within(const Corners& t, Vec3 from, Vec3 way, double least,
                                    Approach state) const noexcept {
  const double along = std::clamp(-dot(state.d, way) / dot(way, way), 0.0, 1 - state.t);
  return norm(state.d + along * way) <= least || advance(t, from, way, least, least, 1, state);
}

void ContactTriangles::sweep_triangle(std::uint32_t place, Sweep& sweep) const noexcept {
  if (tallest_ > 0 && has_relief(place))
    sweep_relief(place, sweep);
  else
    sweep_plain(place, sweep);
}

void ContactTriangles::sweep_plain(std::uint32_t place, Sweep& sweep) const noexcept {
  const Corners t = corners(place);
  const Vec3 from = sweep.from, way = sweep.way;
  const double contact = contact_radius_m(), t_max = sweep.until();
  Approach touch;
  move_approach(t, from, way, 0, touch);
  if ((touch.distance - contact - k_close * tolerance_m()) * touch.distance > -t_max * dot(touch.d, way)) return;
  // The depth is tested first: a grazed neighbour is rejected at once, while its contact converges slowly.
  if (!comes_within(t, from, way, contact - tolerance_m(), touch)) return;
  if (!advance(t, from, way, contact, contact - tolerance_m(), t_max, touch)) return;
  Vec3 normal = (1 / touch.distance) * touch.d;
  if (!(touch.distance > 0)) {
    normal = normalized(cross(t.b - t.a, t.c - t.a));
    if (dot(normal, way) > 0) normal = -normal;
  }
  if (dot(normal, way) >= 0) return;
  sweep.add({touch.t, normal, contact - touch.distance, source_of(place), material_of(place), place, {}}, touch.above);
}

bool ContactTriangles::is_outside(std::uint32_t place, const Box3f& box) const noexcept {
  const Corner &a = clusters_.corner(place, 0), &b = clusters_.corner(place, 1), &c = clusters_.corner(place, 2);
  bool apart = false;
  for (std::size_t i = 0; i < 3; ++i) {
    apart |= std::max(a[i], std::max(b[i], c[i])) < box.low[i];
    apart |= std::min(a[i], std::min(b[i], c[i])) > box.high[i];
  }
  return apart;
}

/// Scenes with relief have no grace: contacts are found at half the tolerance, so a later one may be earlier in truth.
ContactTriangles::Sweep ContactTriangles::make_sweep(Vec3 from, Vec3 to) const noexcept {
  const Vec3 way = to - from;
  const double length = norm(way);
  return {from - origin_, way, nullptr, tallest_ > 0 || length == 0 ? 0 : k_crease * tolerance_m() / length};
}

void ContactTriangles::sweep_cluster(std::uint32_t cluster, Sweep& sweep) const noexcept {
  const Box3f box = box_around(sweep.from, sweep.from + sweep.until() * sweep.way, contact_radius_m());
  clusters_.in_box(cluster, box, [&](std::uint32_t place) noexcept {
    if (has_relief(place) || !is_outside(place, box)) sweep_triangle(place, sweep);
  });
}

std::optional<SweepHit> ContactTriangles::sweep(Vec3 from, Vec3 to) const noexcept {
  Sweep sweep = make_sweep(from, to);
  double t_max = 1;
  clusters_.along(sweep.from, sweep.way, contact_radius_m(), t_max, [&](std::uint32_t cluster) noexcept {
    sweep_cluster(cluster, sweep);
    t_max = sweep.until();
  });
  return sweep.best;
}

bool ContactTriangles::gather(Vec3 centre, double radius_m, Neighbourhood& near) const noexcept {
  constexpr std::uint32_t k_full = TriangleClusters::k_most / TriangleClusters::k_block;
  std::array<std::uint32_t, Neighbourhood::k_blocks / k_full> met;  // Most clusters are full.
  std::uint32_t count = 0;
  bool fits = true;
  double radius = radius_m + contact_radius_m();
  clusters_.within(centre - origin_, radius, [&](std::uint32_t cluster) noexcept {
    fits = count < met.size();
    if (fits)
      met[count++] = cluster;
    else
      radius = 0;  // Ends the walk.
    clusters_.prefetch(cluster);
  });
  near.begin(centre - origin_, radius_m);
  for (std::uint32_t i = 0; i < count && fits; ++i) {
    const std::uint32_t first = clusters_.first_block(met[i]), end = first + clusters_.blocks_of(met[i]);
    for (std::uint32_t block = first; block < end && fits; ++block) {
      fits = !near.full();
      if (!fits || near.add_known(block)) continue;
      near.add(block, clusters_.box_of(block));
      clusters_.prefetch_block(block);
    }
  }
  if (!fits) near.clear_boxes();
  return fits;
}

static_assert(TriangleClusters::k_block == Neighbourhood::k_lanes);

/// Makes the prisms of block i of the neighbourhood. Lanes without a triangle repeat the last one.
void ContactTriangles::make_prisms(std::uint32_t i, Neighbourhood& near) const noexcept {
  const std::uint32_t block = near.block(i), begin = block * Neighbourhood::k_lanes;
  const std::uint32_t last = clusters_.triangles_in(block) - 1;
  const Corner origin = clusters_.corner(begin, 0);
  Neighbourhood::Corners corners;
  for (std::uint32_t lane = 0; lane < Neighbourhood::k_lanes; ++lane) {
    const std::uint32_t place = begin + std::min(lane, last);
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& corner = clusters_.corner(place, k);
      for (std::size_t axis = 0; axis < 3; ++axis) corners.x[3 * k + axis][lane] = corner[axis] - origin[axis];
    }
    corners.top[lane] = tallest_ > 0 ? static_cast<float>(relief_top(place)) : 0;
  }
  near.make(i, origin, corners);
}

std::optional<SweepHit> ContactTriangles::sweep(Vec3 from, Vec3 to, Neighbourhood& near,
                                                KnownFaces& known) const noexcept {
  double seen = 0;
  const auto hit = sweep(from, to, near, known, seen);
  return hit || seen >= 1 ? hit : sweep(from, to);
}

std::optional<SweepHit> ContactTriangles::sweep(Vec3 from, Vec3 to, Neighbourhood& near, KnownFaces& known,
                                                double& seen) const noexcept {
  Sweep sweep = make_sweep(from, to);
  sweep.known = &known;
  const double length = norm(sweep.way), margin = near.margin(sweep.from + seen * sweep.way);
  if (!(margin > 0)) return std::nullopt;
  const double end = (1 - seen) * length > margin ? seen + margin / length : 1;
  // A long segment leads into the surface and is most often stopped at its start; a short one leads along it.
  double piece = length > k_short_way * skin_ ? skin_ / length : 1;
  while (!sweep.best && seen < end) {
    sweep.t_max = std::min(seen + piece, end);
    sweep_prisms(near, seen, sweep);
    seen = sweep.t_max;
    piece *= k_short_way;
  }
  if (sweep.best) known.touched = sweep.best->place;
  return sweep.best;
}

/// Tests the triangles in the order of the lower bounds of their contacts, until none can come before the hit. There is
/// no contact before `since`.
void ContactTriangles::sweep_prisms(Neighbourhood& near, double since, Sweep& sweep) const noexcept {
  struct Open {
    float earliest;
    std::uint32_t place;
  };
  std::array<Open, Neighbourhood::k_blocks * Neighbourhood::k_lanes> open;
  Neighbourhood::Numbers blocks;
  const double contact = contact_radius_m();
  const Vec3 from = sweep.from, way = sweep.way;
  const double until = sweep.t_max;
  const std::uint32_t block_count = near.along(from + since * way, (until - since) * way, contact, blocks);
  std::uint32_t count = 0;
  Neighbourhood::ContactBounds bounds;
  const auto test_blocks = [&]() noexcept {
    near.bound_contacts(from, way, contact, tolerance_m(), since, until, bounds);
    for (std::uint32_t i = 0; i < bounds.count; ++i) {
      const std::uint32_t block = near.block(bounds.block[i]);
      std::uint32_t met = bounds.met[i] & ((1U << clusters_.triangles_in(block)) - 1);
      for (; met != 0; met &= met - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(met));
        open[count++] = {bounds.earliest[i][lane], block * Neighbourhood::k_lanes + lane};
      }
    }
    bounds.count = 0;
  };
  for (std::uint32_t b = 0; b < block_count; ++b) {
    if (!near.has_prisms(blocks[b])) {
      test_blocks();  // Before a new block replaces one of them.
      make_prisms(blocks[b], near);
    }
    bounds.block[bounds.count++] = blocks[b];
    if (bounds.count == Neighbourhood::k_together) test_blocks();
  }
  test_blocks();
  // With relief most bounds are the start: whatever its own is, the triangle that was touched last comes first, for it
  // most often shortens the segment for the others.
  if (tallest_ > 0)
    for (std::uint32_t k = 0; k < count; ++k)
      if (open[k].place == sweep.known->touched) {
        sweep_triangle(open[k].place, sweep);
        open[k] = open[--count];
        break;
      }
  while (count > 0) {
    std::uint32_t next = 0;
    for (std::uint32_t k = 1; k < count; ++k)
      if (open[k].earliest < open[next].earliest) next = k;
    const Open now = open[next];
    if (static_cast<double>(now.earliest) > sweep.until()) break;
    open[next] = open[--count];
    sweep_triangle(now.place, sweep);
  }
}

}  // namespace papilla
