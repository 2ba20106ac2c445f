// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>

#include "contact_triangles.hpp"

namespace papilla {
namespace {

// Accuracy of a contact, of the tolerance. A coplanar neighbour is touched later than the face by ε²/2r, ε the distance
// to the common edge: contacts must be resolved finer, or the neighbour's tilted normal would be taken.
constexpr double k_close = 1e-7;
constexpr double k_crease = 0.25;              // Of the tolerance: distance within which a second face is a crease.
constexpr double k_same_direction = 1 - 1e-9;  // Cosine of normals that count as equal.
constexpr double k_short_way = 16;             // Skins; also the growth of the pieces of a long segment.
constexpr int k_newton_steps = 40;             // Bound; convergence is quadratic.
constexpr int k_march_steps = 512;             // Most steps over a relief, whatever the number of its texels.
constexpr double k_nearer = 0.5;               // Of the rest of the segment: next share tried by stays_clear().
constexpr int k_level_steps = 24;              // Bound of the regula falsi.
constexpr double k_above_level = 1e-4;         // Of the tolerance: accuracy of the level.

}  // namespace

/// The clearance at a parameter of the segment.
struct ContactTriangles::WaySample {
  double t;
  Clearance clearance;
};

/// The segment of a probe, from + t·way up to t_max, and its first contact.
struct ContactTriangles::Sweep {
  Vec3 from, way;
  double grace = 0;  ///< A contact that is later than the first by at most this is the other face of a crease.
  double t_max = 1;
  std::optional<SweepHit> best{};
  bool best_is_flat = false;

  /// Largest parameter of a contact that still matters. A little more than t, so that rounding does not hide a contact
  /// at the same place.
  double until() const noexcept {
    return best ? std::min(t_max, best->t + std::max(grace, 1e-9 * best->t + 1e-12)) : t_max;
  }

  /// The earlier of two contacts; at the same parameter, usually 0, the deeper one, which among coplanar triangles is
  /// the one below the probe; among equals the one with the lower index, so that the order of the search is irrelevant.
  template <class Hit, class Other>
  static bool comes_before(const Hit& a, const Other& b) noexcept {
    if (a.t != b.t) return a.t < b.t;
    return a.penetration_m != b.penetration_m ? a.penetration_m > b.penetration_m : a.triangle < b.triangle;
  }

  /// @param flat the triangle is plain and touched above its face: only such faces form a crease.
  void add(SweepHit hit, bool flat) noexcept {
    if (!best) {
      best = hit;
      best_is_flat = flat;
      return;
    }
    const auto crease = best->crease;
    if (comes_before(hit, *best)) {
      std::swap(hit, *best);
      std::swap(flat, best_is_flat);
    }
    best->crease.reset();
    if (flat) add_crease({hit.t, hit.normal, hit.penetration_m, hit.triangle, hit.material, hit.place});
    if (crease) add_crease(*crease);
  }

  void add_crease(const SweepHit::Crease& hit) noexcept {
    if (hit.t > best->t + grace || dot(hit.normal, best->normal) >= k_same_direction) return;
    if (!best->crease || comes_before(hit, *best->crease)) best->crease = hit;
  }
};

[[gnu::always_inline]] inline void ContactTriangles::move_approach(const Corners& t, Vec3 from, Vec3 way, double to,
                                                                   Approach& state) noexcept {
  const Vec3 x = from + to * way;
  const Foot near = foot(t, x);
  state.t = to;
  state.d = x - near.point;
  state.above = near.on == Foot::On::face;
  state.distance = norm(state.d);
}

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

/// A segment relative to a triangle with relief.
struct ContactTriangles::FaceWay {
  const Face& face;
  Vec3 way;
  double rise;  ///< Length along the normal.

  FaceWay(const Face& f, Vec3 w) noexcept : face(f), way(w), rise(dot(f.normal, w)) {}

  /// Length along the face.
  double slide() const noexcept { return std::sqrt(std::max(0.0, dot(way, way) - rise * rise)); }
  /// Number of texels that it crosses.
  double texels() const noexcept {
    const Vec2 weights = face.weights_of(way);
    return norm(weights.x * face.texel_v + weights.y * face.texel_w);
  }
  /// Upper bound of the slope of the relief above the base.
  double steepest() const noexcept {
    if (face.height == nullptr) return 0;
    const Vec2 steep = face.height->steepest_m();
    return steep.x * norm(face.in_plane(face.texel_v.x, face.texel_w.x)) +
           steep.y * norm(face.in_plane(face.texel_v.y, face.texel_w.y)) +
           norm(face.in_plane(face.shift_v, face.shift_w));
  }
};

/// Whether a share of the segment, from the sample `now` on, provably stays clear. The triangle lies behind the plane
/// through the foot orthogonal to `now.d`, which bounds the distance from below; the foot moves no farther than the
/// probe does along the face, which bounds the relief by its steepest slope; and the cosine is at most that of the
/// highest point of the segment at that distance. The skin makes the relief no steeper.
bool ContactTriangles::stays_clear(const FaceWay& over, const Clearance& now, double share) const noexcept {
  const double nearest = now.distance + std::min(0.0, share * dot(now.d, over.way) / now.distance);
  const double room = nearest - contact_radius_m();
  if (!(room > 0)) return false;
  const double highest = dot(over.face.normal, now.d) + std::max(0.0, share * over.rise);
  const double cosine = std::clamp(highest / nearest, 0.0, 1.0);
  return room > cosine * std::min(over.face.top, now.lift + share * over.steepest() * over.slide()) + tolerance_m();
}

/// Marches over the relief, each time as far as stays_clear() proves or half a texel, and refines the contact in the
/// step that enters.
void ContactTriangles::sweep_relief(std::uint32_t place, Sweep& sweep) const noexcept {
  const Vec3 from = sweep.from, way = sweep.way;
  const double t_max = sweep.until();
  const Face face = this->face(place);
  const double length = norm(way), reach = contact_radius_m() + face.top;
  Approach entry;
  move_approach(face.t, from, way, 0, entry);
  if (!advance(face.t, from, way, reach, reach - tolerance_m(), t_max, entry)) return;
  const FaceWay over(face, way);
  const double finest = std::max(0.5 / std::max(over.texels(), 0.5), 1.0 / k_march_steps);

  // In a hollow every tangent enters at once: half the tolerance lets the probe move on.
  const double level = -0.5 * tolerance_m();
  WaySample outside{entry.t, clearance_of(face, from + entry.t * way)}, inside = outside;
  double allowed = -tolerance_m();
  for (bool first = true;; first = false) {
    const Clearance& now = inside.clearance;
    // A probe that is too deep at the start may rise.
    if (now.value < allowed && (!first || dot(now.gradient, way) < 0)) break;
    allowed = std::min(-tolerance_m(), now.value);
    if (now.value >= level) outside = inside;
    if (inside.t >= t_max) return;
    // Never past the base, behind which the clearance grows again.
    const double base = std::max(0.5 * now.distance, tolerance_m());
    double next = std::min(t_max, inside.t + std::min(finest, base / length));
    if (!(next > inside.t)) break;  // The step is below the resolution of t.
    if (now.value > tolerance_m()) {
      const double rest = t_max - inside.t;
      if (stays_clear(over, now, rest)) return;
      double clear = k_nearer * rest;
      while (inside.t + clear > next && !stays_clear(over, now, clear)) clear *= k_nearer;
      next = std::max(next, inside.t + clear);
    }
    inside = {next, clearance_of(face, from + next * way)};
  }
  const WaySample there = find_level(face, from, way, level, outside, inside);
  sweep.add({there.t,
             normalized(there.clearance.gradient),
             -there.clearance.value,
             source_of(place),
             material_of(place),
             place,
             {}},
            false);
}

/// The sample between two where the clearance falls to the level, at most k_above_level above it: regula falsi with
/// halved weights of the end that stays (Illinois) [Dowell and Jarratt, BIT 11, 1971].
ContactTriangles::WaySample ContactTriangles::find_level(const Face& face, Vec3 from, Vec3 way, double level,
                                                         WaySample outside, const WaySample& inside) const noexcept {
  const double close = k_above_level * tolerance_m(), target = level + close;
  double above = outside.clearance.value - target, below = inside.clearance.value - target, end = inside.t;
  bool moved_outside = false, moved_inside = false;
  for (int step = 0; step < k_level_steps && outside.clearance.value > target + close && end - outside.t > 1e-9;
       ++step) {
    const double at = outside.t + (end - outside.t) * above / (above - below);
    const WaySample now{at, clearance_of(face, from + at * way)};
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
  return {from - origin_, way, tallest_ > 0 || length == 0 ? 0 : k_crease * tolerance_m() / length};
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

std::optional<SweepHit> ContactTriangles::sweep(Vec3 from, Vec3 to, Neighbourhood& near) const noexcept {
  double seen = 0;
  const auto hit = sweep(from, to, near, seen);
  return hit || seen >= 1 ? hit : sweep(from, to);
}

std::optional<SweepHit> ContactTriangles::sweep(Vec3 from, Vec3 to, Neighbourhood& near, double& seen) const noexcept {
  Sweep sweep = make_sweep(from, to);
  const double length = norm(sweep.way), margin = near.margin(sweep.from + seen * sweep.way);
  if (!(margin > 0)) return std::nullopt;
  const double known = (1 - seen) * length > margin ? seen + margin / length : 1;
  // A long segment leads into the surface and is most often stopped at its start; a short one leads along it.
  double piece = length > k_short_way * skin_ ? skin_ / length : 1;
  while (!sweep.best && seen < known) {
    sweep.t_max = std::min(seen + piece, known);
    sweep_prisms(near, seen, sweep);
    seen = sweep.t_max;
    piece *= k_short_way;
  }
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
