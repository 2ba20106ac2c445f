// SPDX-License-Identifier: MIT
#include <bit>

#include "contact_triangles.hpp"

namespace papilla {
namespace {

constexpr double k_opposite = 1e-9;  // Sine below which two directions count as parallel.

using Foot = ContactTriangles::Foot;

/// Direction out of the triangle across its border at the closest point; zero inside the face.
Vec3 off(const ContactTriangles::Corners& t, const Foot& foot) noexcept {
  if (foot.on == Foot::On::face) return {};
  const Vec3 out = foot.point - (1.0 / 3) * (t.a + t.b + t.c), along = foot.edge;
  return foot.on == Foot::On::edge ? out - (dot(out, along) / dot(along, along)) * along : out;
}

/// The cone of the directions in which the triangles with a common closest point end, seen along an axis. It is closed
/// when the triangles surround the point.
class EndCone {
 public:
  void add(Vec3 off, Vec3 axis) noexcept {
    closed_ = closed_ || off == Vec3{};
    if (closed_) return;
    if (first_ == Vec3{}) first_ = last_ = off;
    const double rounding = k_opposite * norm(axis) * norm(off);
    const bool after = dot(cross(first_, off), axis) >= -rounding * norm(first_);
    const bool before = dot(cross(off, last_), axis) >= -rounding * norm(last_);
    if (after && before)
      closed_ = across(first_, off, axis) && across(last_, off, axis);
    else if (after)
      last_ = off;
    else if (before)
      first_ = off;
    else
      closed_ = true;
  }

  /// The axis of the cone; zero when it is closed.
  Vec3 middle() const noexcept { return closed_ ? Vec3{} : normalized(normalized(first_) + normalized(last_)); }

 private:
  /// More than a right angle apart.
  static bool across(Vec3 a, Vec3 b, Vec3 axis) noexcept {
    return dot(a, b) * dot(axis, axis) < dot(a, axis) * dot(b, axis);
  }

  Vec3 first_, last_;  // Counter-clockwise, less than half a turn.
  bool closed_ = false;
};

}  // namespace

/// The nearest triangle so far, and the end cone of all triangles with the same closest point.
struct ContactTriangles::NearestSoFar {
  double distance;  ///< Farther triangles are ignored.
  double same;      ///< Closest points nearer to each other than that count as one.
  Vec3 away{};      ///< From x to the closest point; zero as long as there is none.
  std::uint32_t place = 0;
  EndCone ends{};

  void add(const Corners& t, const Foot& foot, Vec3 from, std::uint32_t at) noexcept {
    const Vec3 d = foot.point - from;
    const double length = norm(d);
    const bool is_same = norm(d - away) < same;
    if (length >= distance && !is_same) return;
    if (!is_same) ends = {};
    ends.add(off(t, foot), d);
    if (length < distance) distance = length, away = d, place = at;
  }
};

/// Adds the triangles of block i in the order of their lower bounds: the first one rules out most of the others.
void ContactTriangles::update_nearest(std::uint32_t i, Vec3 x, const Neighbourhood& near,
                                      NearestSoFar& nearest) const noexcept {
  const std::uint32_t block = near.block(i);
  Neighbourhood::Lanes least;
  std::uint32_t nearer = near.distances(i, x, nearest.distance, least) & ((1U << clusters_.triangles_in(block)) - 1);
  while (nearer != 0) {
    auto lane = static_cast<std::uint32_t>(std::countr_zero(nearer));
    for (std::uint32_t others = nearer & (nearer - 1); others != 0; others &= others - 1) {
      const auto other = static_cast<std::uint32_t>(std::countr_zero(others));
      if (least[other] < least[lane]) lane = other;
    }
    if (static_cast<double>(least[lane]) >= nearest.distance) return;
    nearer &= ~(1U << lane);
    const std::uint32_t place = block * Neighbourhood::k_lanes + lane;
    const Corners t = corners(place);
    nearest.add(t, foot(t, x), x, place);
  }
}

std::optional<ContactTriangles::Rest> ContactTriangles::rest_candidate(Vec3 goal, double radius_m, Vec3 normal,
                                                                       Neighbourhood& near) const noexcept {
  if (tallest_ > 0) return std::nullopt;
  const Vec3 x = goal - origin_;
  const double contact = contact_radius_m();
  Neighbourhood::Numbers blocks;
  Neighbourhood::Distances least;
  // A goal that is no deeper than the contact radius is in front of the surface.
  NearestSoFar nearest{radius_m > contact ? radius_m - contact : contact, tolerance_m()};
  const std::uint32_t count = near.around(x, nearest.distance, blocks, least);
  // Blocks with prisms first; the others get theirs only where they may be nearer than everything found so far.
  for (const bool made : {true, false})
    for (std::uint32_t b = 0; b < count; ++b) {
      if (static_cast<double>(least[b]) >= nearest.distance || near.has_prisms(blocks[b]) != made) continue;
      if (!made) make_prisms(blocks[b], near);
      update_nearest(blocks[b], x, near, nearest);
    }
  const Vec3 away = nearest.away;
  if (away == Vec3{}) return std::nullopt;
  const double beyond = (dot(away, normal) >= 0 ? contact : -contact) / nearest.distance;
  return Rest{goal + away + beyond * away, nearest.ends.middle(), material_of(nearest.place), nearest.place};
}

}  // namespace papilla
