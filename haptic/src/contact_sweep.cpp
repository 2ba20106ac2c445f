// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>

#include "contact_triangle.hpp"

namespace papilla {
namespace {

// Of the tolerance. Coplanar neighbours touch later than the face by ε²/2r, ε the distance to the common edge: the
// times must be finer than that, or the neighbour's tilted normal would be taken.
constexpr double k_close = 1e-7;
constexpr double k_beside = 0.25;  // Of the tolerance.
constexpr double k_same_direction = 1 - 1e-9;
constexpr double k_short_way = 16;  // Skins; and how much farther each piece of a long way leads than the one before.
constexpr int k_newton_steps = 40;
constexpr int k_march_steps = 512;
constexpr double k_nearer = 0.5;
constexpr int k_sink_steps = 24;
constexpr double k_above_level = 1e-4;  // Of the tolerance.

}  // namespace

/// A place on a way.
struct ContactSurface::Sunk {
  double t;
  Clearance clearance;
};

/// The way of a probe, from + t·way up to t_max, and what it has met.
struct ContactSurface::Sweep {
  Vec3 from, way;
  double grace = 0;  ///< What is met so much of the way after the first hit stands beside it.
  double t_max = 1;
  std::optional<SweepHit> best{};
  bool best_is_flat = false;

  /// Until where a hit still matters. A little after t: what is met at the same place must not be left out by a
  /// rounding.
  double until() const noexcept {
    return best ? std::min(t_max, best->t + std::max(grace, 1e-9 * best->t + 1e-12)) : t_max;
  }

  /// The earlier of two hits; of those at the same place, usually the start, the deeper one: where triangles meet flat,
  /// it is the one that x stands above. Of equals the first of the mesh, so that the order of looking doesn't matter.
  template <class Hit, class Other>
  static bool comes_before(const Hit& a, const Other& b) noexcept {
    if (a.t != b.t) return a.t < b.t;
    return a.penetration_m != b.penetration_m ? a.penetration_m > b.penetration_m : a.triangle < b.triangle;
  }

  /// @param flat it is met above its face, where it is a plane: only such can stand beside another.
  void take(SweepHit hit, bool flat) noexcept {
    if (!best) {
      best = hit;
      best_is_flat = flat;
      return;
    }
    const auto beside = best->beside;
    if (comes_before(hit, *best)) {
      std::swap(hit, *best);
      std::swap(flat, best_is_flat);
    }
    best->beside.reset();
    if (flat) stand_beside({hit.t, hit.normal, hit.penetration_m, hit.triangle, hit.material});
    if (beside) stand_beside(*beside);
  }

  void stand_beside(const SweepHit::Beside& hit) noexcept {
    if (hit.t > best->t + grace || dot(hit.normal, best->normal) >= k_same_direction) return;
    if (!best->beside || comes_before(hit, *best->beside)) best->beside = hit;
  }
};

[[gnu::always_inline]] inline void ContactSurface::look(const Corners& t, Vec3 from, Vec3 way, double at,
                                                        Approach& state) noexcept {
  const Vec3 x = from + at * way;
  const Foot near = foot(t, x);
  state.t = at;
  state.d = x - near.point;
  state.above = near.on == Foot::On::face;
  state.distance = norm(state.d);
}

/// Goes on from `state` to the first t up to t_max where from + t·way is within `radius` of the triangle. The distance
/// to a convex set is convex on a line, so Newton's steps from outside end at or before the contact: nothing is passed
/// over, and the tangent tells early that t = 1 isn't within `least`. @returns false when there is none, or never less
/// than `least`.
bool ContactSurface::approach(const Corners& t, Vec3 from, Vec3 way, double radius, double least, double t_max,
                              Approach& state) const noexcept {
  const double close = k_close * tolerance_m();
  for (int step = 0; step < k_newton_steps; ++step) {
    if (state.distance <= radius + close) return true;
    const double descent = -dot(state.d, way);
    if (descent <= 0) return false;
    const double way_there = (state.distance - radius) * state.distance;
    if (way_there > (t_max - state.t) * descent) return false;
    if ((state.distance - least - close) * state.distance > (1 - state.t) * descent) return false;
    look(t, from, way, state.t + way_there / descent, state);
  }
  return true;
}

/// Whether the way from `state` comes within `least` of the triangle. The point that is nearest to its start tells it
/// most often: the triangle is at least as near as that.
bool ContactSurface::goes_deep(const Corners& t, Vec3 from, Vec3 way, double least, Approach state) const noexcept {
  const double along = std::clamp(-dot(state.d, way) / dot(way, way), 0.0, 1 - state.t);
  return norm(state.d + along * way) <= least || approach(t, from, way, least, least, 1, state);
}

void ContactSurface::sweep_one(std::uint32_t place, Sweep& sweep) const noexcept {
  if (tallest_ > 0 && has_relief(place))
    sweep_relief(place, sweep);
  else
    sweep_plain(place, sweep);
}

void ContactSurface::sweep_plain(std::uint32_t place, Sweep& sweep) const noexcept {
  const Corners t = corners(place);
  const Vec3 from = sweep.from, way = sweep.way;
  const double contact = contact_radius_m(), t_max = sweep.until();
  Approach touch;
  look(t, from, way, 0, touch);
  if ((touch.distance - contact - k_close * tolerance_m()) * touch.distance > -t_max * dot(touch.d, way)) return;
  // Whether it goes deep is asked first: a neighbour that the way only grazes is told at once, its touch found slowly.
  if (!goes_deep(t, from, way, contact - tolerance_m(), touch)) return;
  if (!approach(t, from, way, contact, contact - tolerance_m(), t_max, touch)) return;
  Vec3 normal = (1 / touch.distance) * touch.d;
  if (!(touch.distance > 0)) {
    normal = normalized(cross(t.b - t.a, t.c - t.a));
    if (dot(normal, way) > 0) normal = -normal;
  }
  if (dot(normal, way) >= 0) return;
  sweep.take({touch.t, normal, contact - touch.distance, source_of(place), material_of(place), {}}, touch.above);
}

/// A way as a triangle with relief sees it.
struct ContactSurface::WayOver {
  const Face& face;
  Vec3 way;
  double rise, slide;   ///< How far it leads along the normal and along the face.
  double texels = 0;    ///< How many of the relief it crosses.
  double steepest = 0;  ///< As the relief, with its base, is at most.

  WayOver(const Face& f, Vec3 w) noexcept
      : face(f), way(w), rise(dot(f.normal, w)), slide(std::sqrt(std::max(0.0, dot(w, w) - rise * rise))) {
    if (f.height == nullptr) return;
    const auto [per_u, per_v] = f.height->texels_per_uv();
    const Vec2 by_v = f.uv_v.x * per_u + f.uv_v.y * per_v, by_w = f.uv_w.x * per_u + f.uv_w.y * per_v;
    const Vec2 weights = f.weights_of(w), steep = f.height->steepest_m();
    texels = norm(weights.x * by_v + weights.y * by_w);
    steepest = steep.x * norm(f.in_plane(by_v.x, by_w.x)) + steep.y * norm(f.in_plane(by_v.y, by_w.y)) +
               norm(f.in_plane(f.shift_v, f.shift_w));
  }
};

/// Whether a share of the way from where the clearance is `now` stays clear. The triangle lies behind the plane through
/// the foot that looks at the probe, so that the distance is at least that from this plane; the foot goes no farther
/// than the way does along the face; and the relief counts by at most the cosine that the highest point of the way has
/// at that distance. With the skin on it the relief is no steeper than without.
bool ContactSurface::stays_clear(const WayOver& over, const Clearance& now, double share) const noexcept {
  const double nearest = now.distance + std::min(0.0, share * dot(now.d, over.way) / now.distance);
  const double room = nearest - contact_radius_m();
  if (!(room > 0)) return false;
  const double highest = dot(over.face.normal, now.d) + std::max(0.0, share * over.rise);
  const double cosine = std::clamp(highest / nearest, 0.0, 1.0);
  return room > cosine * std::min(over.face.top, now.lift + share * over.steepest * over.slide) + tolerance_m();
}

/// Steps over the relief, as far as the way surely stays clear or half a texel, and finds the level in the step that
/// goes in.
void ContactSurface::sweep_relief(std::uint32_t place, Sweep& sweep) const noexcept {
  const Vec3 from = sweep.from, way = sweep.way;
  const double t_max = sweep.until();
  const double length = norm(way), reach = contact_radius_m() + top_of(place);
  Approach entry;
  look(corners(place), from, way, 0, entry);
  if (!approach(corners(place), from, way, reach, reach - tolerance_m(), t_max, entry)) return;
  const Face face = this->face(place);
  const WayOver over(face, way);
  const double finest = std::max(0.5 / std::max(over.texels, 0.5), 1.0 / k_march_steps);

  // On a hollow every tangent goes in at once: half the tolerance lets the probe get on.
  const double level = -0.5 * tolerance_m();
  Sunk outside{entry.t, clearance_of(face, from + entry.t * way)}, inside = outside;
  double allowed = -tolerance_m();
  for (bool first = true;; first = false) {
    const Clearance& now = inside.clearance;
    // A probe that is too deep already may rise.
    if (now.value < allowed && (!first || dot(now.gradient, way) < 0)) break;
    allowed = std::min(-tolerance_m(), now.value);
    if (now.value >= level) outside = inside;
    if (inside.t >= t_max) return;
    // Not past the base: behind it the clearance grows again.
    const double base = std::max(0.5 * now.distance, tolerance_m());
    double next = std::min(t_max, inside.t + std::min(finest, base / length));
    if (!(next > inside.t)) break;  // Too small a step for a number: it stops here.
    if (now.value > tolerance_m()) {
      const double rest = t_max - inside.t;
      if (stays_clear(over, now, rest)) return;
      double clear = k_nearer * rest;
      while (inside.t + clear > next && !stays_clear(over, now, clear)) clear *= k_nearer;
      next = std::max(next, inside.t + clear);
    }
    inside = {next, clearance_of(face, from + next * way)};
  }
  const Sunk there = sink(face, from, way, level, outside, inside);
  sweep.take(
      {there.t, normalized(there.clearance.gradient), -there.clearance.value, source_of(place), material_of(place), {}},
      false);
}

/// A place between the two, from + t·way, that is at the level and no more than a little above it: regula falsi, where
/// an end that stays counts half each time [Dowell and Jarratt, BIT 11, 1971].
ContactSurface::Sunk ContactSurface::sink(const Face& face, Vec3 from, Vec3 way, double level, Sunk outside,
                                          const Sunk& inside) const noexcept {
  const double close = k_above_level * tolerance_m(), target = level + close;
  double above = outside.clearance.value - target, below = inside.clearance.value - target, end = inside.t;
  bool moved_outside = false, moved_inside = false;
  for (int step = 0; step < k_sink_steps && outside.clearance.value > target + close && end - outside.t > 1e-9;
       ++step) {
    const double at = outside.t + (end - outside.t) * above / (above - below);
    const Sunk now{at, clearance_of(face, from + at * way)};
    if (now.clearance.value >= level) {
      if (moved_outside) below *= 0.5;
      outside = now;
      above = now.clearance.value - target;
    } else {
      if (moved_inside) above *= 0.5;
      end = at;
      below = now.clearance.value - target;
    }
    moved_outside = outside.t == at;
    moved_inside = !moved_outside;
  }
  return outside;
}

bool ContactSurface::beside(std::uint32_t place, const Box3f& box) const noexcept {
  const Corner &a = clusters_.corner(place, 0), &b = clusters_.corner(place, 1), &c = clusters_.corner(place, 2);
  bool apart = false;
  for (std::size_t i = 0; i < 3; ++i) {
    apart |= std::max(a[i], std::max(b[i], c[i])) < box.low[i];
    apart |= std::min(a[i], std::min(b[i], c[i])) > box.high[i];
  }
  return apart;
}

/// On relief nothing later is looked at: a hit stands where the relief is half the tolerance deep, which can be before
/// another that was found first.
ContactSurface::Sweep ContactSurface::sweep_between(Vec3 from, Vec3 to) const noexcept {
  const Vec3 way = to - from;
  const double length = norm(way);
  return {from - origin_, way, tallest_ > 0 || length == 0 ? 0 : k_beside * tolerance_m() / length};
}

void ContactSurface::sweep_cluster(std::uint32_t cluster, Sweep& sweep) const noexcept {
  const Box3f box = box_around(sweep.from, sweep.from + sweep.until() * sweep.way, contact_radius_m());
  clusters_.in_box(cluster, box, [&](std::uint32_t place) noexcept {
    if (has_relief(place) || !beside(place, box)) sweep_one(place, sweep);
  });
}

std::optional<SweepHit> ContactSurface::sweep(Vec3 from, Vec3 to) const noexcept {
  Sweep sweep = sweep_between(from, to);
  double t_max = 1;
  clusters_.along(sweep.from, sweep.way, contact_radius_m(), t_max, [&](std::uint32_t cluster) noexcept {
    sweep_cluster(cluster, sweep);
    t_max = sweep.until();
  });
  return sweep.best;
}

bool ContactSurface::gather(Vec3 centre, double radius_m, Neighbourhood& near) const noexcept {
  constexpr std::uint32_t k_full = TriangleClusters::k_most / TriangleClusters::k_block;
  std::array<std::uint32_t, Neighbourhood::k_blocks / k_full> met;  // More would hardly fit: most are full.
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
      if (!fits || near.add_made(block)) continue;
      near.add(block, clusters_.box_of(block));
      clusters_.prefetch_block(block);
    }
  }
  if (!fits) near.forget_place();
  return fits;
}

static_assert(TriangleClusters::k_block == Neighbourhood::k_lanes);

/// Of the triangles of block i of the neighbourhood. Lanes without a triangle repeat the last.
void ContactSurface::make_prisms(std::uint32_t i, Neighbourhood& near) const noexcept {
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
    corners.top[lane] = tallest_ > 0 ? static_cast<float>(top_of(place)) : 0;
  }
  near.make(i, origin, corners);
}

std::optional<SweepHit> ContactSurface::sweep(Vec3 from, Vec3 to, Neighbourhood& near) const noexcept {
  double seen = 0;
  const auto hit = sweep(from, to, near, seen);
  return hit || seen >= 1 ? hit : sweep(from, to);
}

std::optional<SweepHit> ContactSurface::sweep(Vec3 from, Vec3 to, Neighbourhood& near, double& seen) const noexcept {
  Sweep sweep = sweep_between(from, to);
  const double length = norm(sweep.way), margin = near.margin(sweep.from + seen * sweep.way);
  if (!(margin > 0)) return std::nullopt;
  const double known = (1 - seen) * length > margin ? seen + margin / length : 1;
  // A long way goes into the surface and is most often stopped where it starts, a short one leads along it.
  double piece = length > k_short_way * skin_ ? skin_ / length : 1;
  while (!sweep.best && seen < known) {
    sweep.t_max = std::min(seen + piece, known);
    sweep_prisms(near, seen, sweep);
    seen = sweep.t_max;
    piece *= k_short_way;
  }
  return sweep.best;
}

/// Looks at the triangles in the order in which they could be met at the earliest, until none can be met before the
/// hit. Nothing is met before `since`.
void ContactSurface::sweep_prisms(Neighbourhood& near, double since, Sweep& sweep) const noexcept {
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
  Neighbourhood::Meetings meetings;
  const auto meet = [&]() noexcept {
    near.near_way(from, way, contact, tolerance_m(), since, until, meetings);
    for (std::uint32_t i = 0; i < meetings.count; ++i) {
      const std::uint32_t block = near.block(meetings.block[i]);
      std::uint32_t met = meetings.met[i] & ((1U << clusters_.triangles_in(block)) - 1);
      for (; met != 0; met &= met - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(met));
        open[count++] = {meetings.earliest[i][lane], block * Neighbourhood::k_lanes + lane};
      }
    }
    meetings.count = 0;
  };
  for (std::uint32_t b = 0; b < block_count; ++b) {
    if (!near.is_made(blocks[b])) {
      meet();  // Before one of them has to make room.
      make_prisms(blocks[b], near);
    }
    meetings.block[meetings.count++] = blocks[b];
    if (meetings.count == Neighbourhood::k_together) meet();
  }
  meet();
  while (count > 0) {
    std::uint32_t next = 0;
    for (std::uint32_t k = 1; k < count; ++k)
      if (open[k].earliest < open[next].earliest) next = k;
    const Open now = open[next];
    if (static_cast<double>(now.earliest) > sweep.until()) break;
    open[next] = open[--count];
    sweep_one(now.place, sweep);
  }
}

}  // namespace papilla
