// SPDX-License-Identifier: MIT
#include <bit>

#include "contact_triangle.hpp"

namespace papilla {
namespace {

constexpr double k_opposite = 1e-9;  // Sine of the angle to the opposite direction.

/// Away from the triangle at its nearest point; zero within the face.
template <class Corners, class Foot>
Vec3 off(const Corners& t, const Foot& foot) noexcept {
  if (foot.on == Foot::On::face) return {};
  const Vec3 out = foot.point - (1.0 / 3) * (t.a + t.b + t.c), along = foot.edge;
  return foot.on == Foot::On::edge ? out - (dot(out, along) / dot(along, along)) * along : out;
}

/// The directions in which the triangles end that have the same nearest point, seen along an axis: a cone, until they
/// end all around.
class Ends {
 public:
  void add(Vec3 off, Vec3 axis) noexcept {
    all_around_ = all_around_ || off == Vec3{};
    if (all_around_) return;
    if (first_ == Vec3{}) first_ = last_ = off;
    const double rounding = k_opposite * norm(axis) * norm(off);
    const bool after = dot(cross(first_, off), axis) >= -rounding * norm(first_);
    const bool before = dot(cross(off, last_), axis) >= -rounding * norm(last_);
    if (after && before)
      all_around_ = across(first_, off, axis) && across(last_, off, axis);
    else if (after)
      last_ = off;
    else if (before)
      first_ = off;
    else
      all_around_ = true;
  }

  /// The middle of the cone; zero where the triangles end all around.
  Vec3 middle() const noexcept { return all_around_ ? Vec3{} : normalized(normalized(first_) + normalized(last_)); }

 private:
  /// More than a right angle apart.
  static bool across(Vec3 a, Vec3 b, Vec3 axis) noexcept {
    return dot(a, b) * dot(axis, axis) < dot(a, axis) * dot(b, axis);
  }

  Vec3 first_, last_;  // Counter-clockwise, less than half a turn.
  bool all_around_ = false;
};

}  // namespace

/// The nearest triangle of those looked at, and how it ends there together with others that have the same nearest
/// point.
struct ContactSurface::NearestSoFar {
  double distance;  ///< Farther ones don't matter.
  double same;      ///< Nearest points closer to each other than that are one.
  Vec3 away{};      ///< The way there; zero as long as there is none.
  std::uint32_t place = 0;
  Ends ends{};

  void take(const Corners& t, const Foot& foot, Vec3 from, std::uint32_t at) noexcept {
    const Vec3 d = foot.point - from;
    const double length = norm(d);
    const bool is_same = norm(d - away) < same;
    if (length >= distance && !is_same) return;
    if (!is_same) ends = {};
    ends.add(off(t, foot), d);
    if (length < distance) distance = length, away = d, place = at;
  }
};

/// Takes in the triangles of a block that are nearer. The most promising first: it rules out most of the others.
void ContactSurface::nearest_in(std::uint32_t i, Vec3 x, const Neighbourhood& near,
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
    nearest.take(t, foot(t, x), x, place);
  }
}

std::optional<ContactSurface::Rest> ContactSurface::likely_rest(Vec3 goal, double radius_m, Vec3 normal,
                                                                Neighbourhood& near) const noexcept {
  if (tallest_ > 0) return std::nullopt;
  const Vec3 x = goal - origin_;
  const double contact = contact_radius_m();
  Neighbourhood::Numbers blocks;
  Neighbourhood::Distances least;
  // A goal that is no deeper than the radius lies before the surface.
  NearestSoFar nearest{radius_m > contact ? radius_m - contact : contact, tolerance_m()};
  const std::uint32_t count = near.around(x, nearest.distance, blocks, least);
  // What no way came near so far is looked at only where it may be nearer than all that is known.
  for (const bool known : {true, false})
    for (std::uint32_t b = 0; b < count; ++b) {
      if (static_cast<double>(least[b]) >= nearest.distance || near.is_made(blocks[b]) != known) continue;
      if (!known) make_prisms(blocks[b], near);
      nearest_in(blocks[b], x, near, nearest);
    }
  const Vec3 away = nearest.away;
  if (away == Vec3{}) return std::nullopt;
  const double beyond = (dot(away, normal) >= 0 ? contact : -contact) / nearest.distance;
  return Rest{goal + away + beyond * away, nearest.ends.middle(), material_of(nearest.place)};
}

}  // namespace papilla
