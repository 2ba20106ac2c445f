// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>

#include "contact_triangles.hpp"

namespace papilla {

/// The segment of a probe, from + t·way up to t_max, and its first contact.
struct ContactTriangles::Sweep {
  static constexpr double k_same_direction = 1 - 1e-9;  ///< Cosine of normals that count as equal.

  Vec3 from, way;
  KnownFaces* known = nullptr;  ///< None: of a sweep of its own.
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

}  // namespace papilla
