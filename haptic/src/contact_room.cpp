// SPDX-License-Identifier: MIT
// Where a triangle with relief counts. Over a relief that goes on from triangle to triangle, on a plane or an arch, a
// place is felt once, at its closest point: a triangle counts where the closest one of its own points is the nearest of
// all around. At the border to a nearer triangle both have the same closest point, so what a probe feels does not
// depend on the edges between. In a hollow a place has several closest points, and all triangles count.
#include <algorithm>
#include <cmath>

#include "contact_fan.hpp"

namespace papilla {
namespace {

// Of the tolerance.
constexpr double k_margin = 1e-3;    // Rounding must not make two triangles leave a place to each other.
constexpr double k_sharp = 0.1;      // Wider borders are looked for,
constexpr double k_border = 0.0625;  // as exactly as this.

}  // namespace

ContactTriangles::Room ContactTriangles::room(std::uint32_t place, const Face& face) const noexcept {
  Room room;
  if (arch_.empty()) return room;
  const std::uint16_t arch = arch_[clusters_.slot(place)];
  if (arch == k_no_arch) return room;
  room.ends = true;
  room.tilt = arch / k_tilts;
  const std::array<Vec3, 3> corner = face.t.all();
  for (std::size_t k = 0; k < 3; ++k) {
    room.out[k] = normalized(cross(corner[(k + 1) % 3] - corner[k], face.normal));
    room.end[k] = dot(room.out[k], corner[k]) + k_margin * tolerance_m();
  }
  return room;
}

bool ContactTriangles::is_beyond(std::uint32_t place, const Room& room, Vec3 x) const noexcept {
  if (!room.ends) return false;
  const Foot near = foot(corners(place), x);
  const Vec3 d = x - near.point;
  const auto leads_nearer = [&](Vec3 along) noexcept { return dot(d, along) > k_margin * tolerance_m() * norm(along); };
  if (near.on == Foot::On::face) return false;
  if (near.on == Foot::On::edge) {
    const std::uint32_t other = continued(place)[near.w == 0 ? 0 : near.v == 0 ? 2 : 1];
    const Vec3 inwards = corners(other).all()[(edge_towards(other, place) + 2) % 3] - near.point;
    return leads_nearer(inwards - (dot(inwards, near.edge) / dot(near.edge, near.edge)) * near.edge);
  }
  bool beyond = false;
  around(place,
         near.v == 1   ? 1
         : near.w == 1 ? 2
                       : 0,
         [&](std::uint32_t at, std::uint32_t k) noexcept {
           const std::array<Vec3, 3> c = corners(at).all();
           beyond = beyond || leads_nearer(c[(k + 1) % 3] - c[k]);
         });
  return beyond;
}

/// Limits t to where the segment lies over the face or beyond its edges by `slack` at most.
bool ContactTriangles::Room::clip(Vec3 from, Vec3 way, double slack, double& t_min, double& t_max) const noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const double outside = dot(out[k], from) - end[k] - slack, grows = dot(out[k], way);
    const bool begins_outside = outside + t_min * grows > 0, ends_outside = outside + t_max * grows > 0;
    if (begins_outside && ends_outside) return false;
    if (begins_outside) t_min = std::min(t_max, -outside / grows);
    if (ends_outside) t_max = std::max(t_min, -outside / grows);
  }
  return true;
}

/// The triangles around are a graph over the face with no slope above the tilt: h above or below it, one of them is
/// nearer at more than h·tilt beyond an edge. So on a plane the edges are the borders; else they are looked for between
/// a place over the face and the ends. A segment that does not lead over the face and begins beyond leads through at
/// most what the triangle shares with others, along a common edge or corner.
bool ContactTriangles::limit_to_room(const KnownFace& known, Vec3 from, Vec3 way, double& t_min,
                                     double& t_max) const noexcept {
  const Room& room = known.room;
  if (!room.ends) return true;
  const double begin = dot(known.face.normal, from - known.face.t.a), rise = t_max * dot(known.face.normal, way);
  const double slack = room.tilt * std::max(std::abs(begin), std::abs(begin + rise));
  if (!room.clip(from, way, slack, t_min, t_max)) return false;
  if (slack < k_sharp * tolerance_m()) return true;
  double inside = t_min, last_inside = t_max;
  const bool is_over = room.clip(from, way, 0, inside, last_inside);
  if (is_beyond(known.place, room, from + t_min * way)) {
    if (!is_over) return false;
    t_min = border(known, from, way, inside, t_min);
  } else if (!is_over) {
    last_inside = t_min;
  }
  if (is_beyond(known.place, room, from + t_max * way)) t_max = border(known, from, way, last_inside, t_max);
  return true;
}

/// The border between a parameter in the room and one beyond, on the side of the first.
double ContactTriangles::border(const KnownFace& known, Vec3 from, Vec3 way, double inside,
                                double beyond) const noexcept {
  const double close = k_border * tolerance_m() / norm(way);
  while (std::abs(beyond - inside) > close) {
    const double middle = 0.5 * (inside + beyond);
    (is_beyond(known.place, known.room, from + middle * way) ? beyond : inside) = middle;
  }
  return inside;
}

}  // namespace papilla
