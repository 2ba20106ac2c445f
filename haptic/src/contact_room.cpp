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

Vec3 orthogonal(Vec3 v, Vec3 to) noexcept { return v - (dot(v, to) / dot(to, to)) * to; }

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
    const Vec3 edge = corner[(k + 1) % 3] - corner[k];
    room.out[k] = normalized(cross(edge, face.normal));
    room.end[k] = dot(room.out[k], corner[k]) + k_margin * tolerance_m();
    room.beyond[k] = orthogonal(opposite(continued(place)[k], place) - corner[k], edge);
  }
  return room;
}

ContactTriangles::KnownFace ContactTriangles::known_face(std::uint32_t place) const noexcept {
  KnownFace known{place, face(place)};
  known.room = room(place, known.face);
  return known;
}

bool ContactTriangles::is_beyond(const KnownFace& known, Vec3 x) const noexcept {
  const Room& room = known.room;
  if (!room.ends) return false;
  const Foot near = foot(known.face.t, x);
  if (near.on == Foot::On::face) return false;
  const Vec3 d = x - near.point;
  const auto leads_nearer = [&](Vec3 along) noexcept { return dot(d, along) > k_margin * tolerance_m() * norm(along); };
  if (near.on == Foot::On::edge) return leads_nearer(room.beyond[near.w == 0 ? 0 : near.v == 0 ? 2 : 1]);
  bool beyond = false;
  around(known.place,
         near.v == 1   ? 1
         : near.w == 1 ? 2
                       : 0,
         [&](std::uint32_t at, std::uint32_t k) noexcept {
           beyond = beyond || leads_nearer(corner(at, (k + 1) % 3) - near.point);
         });
  return beyond;
}

namespace {

/// The part of a segment from + t·way from one parameter to another.
struct Part {
  double begin, end;

  bool is_empty() const noexcept { return !(begin <= end); }
  /// Leaves out places with normal · x > most.
  [[gnu::noinline]] void clip(Vec3 from, Vec3 way, Vec3 normal, double most) noexcept {
    const double outside = dot(normal, from) - most, grows = dot(normal, way), at = -outside / grows;
    if (outside + begin * grows > 0) begin = grows < 0 ? at : end + 1;
    if (outside + end * grows > 0) end = grows > 0 ? at : begin - 1;
  }
};

}  // namespace

/// The triangles around are a graph over the face with no slope above the tilt: h above or below it, one of them is
/// nearer at more than h·tilt beyond an edge. So on a plane the edges are the borders; else they are looked for between
/// the ends and the part over the face and over the ridges at its edges. A segment that begins beyond and meets neither
/// leads through no more than what all triangles at a corner share.
bool ContactTriangles::limit_to_room(const KnownFace& known, Vec3 from, Vec3 way, double& t_min,
                                     double& t_max) const noexcept {
  const Room& room = known.room;
  if (!room.ends) return true;
  const std::array<Vec3, 3> corner = known.face.t.all();
  const double begin = dot(known.face.normal, from - corner[0]), rise = t_max * dot(known.face.normal, way);
  const double slack = room.tilt * std::max(std::abs(begin), std::abs(begin + rise));
  Part near{t_min, t_max};
  for (std::size_t k = 0; k < 3; ++k) near.clip(from, way, room.out[k], room.end[k] + slack);
  if (near.is_empty()) return false;
  t_min = near.begin;
  t_max = near.end;
  if (slack < k_sharp * tolerance_m()) return true;

  Part inside = near;
  for (std::size_t k = 0; k < 3; ++k) inside.clip(from, way, room.out[k], room.end[k]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 edge = corner[(k + 1) % 3] - corner[k];
    Part ridge = near;
    ridge.clip(from, way, -room.out[k], -room.end[k]);
    ridge.clip(from, way, room.beyond[k], dot(room.beyond[k], corner[k]));
    ridge.clip(from, way, edge, dot(edge, corner[(k + 1) % 3]));
    ridge.clip(from, way, -edge, -dot(edge, corner[k]));
    if (!ridge.is_empty())
      inside = inside.is_empty() ? ridge : Part{std::min(inside.begin, ridge.begin), std::max(inside.end, ridge.end)};
  }
  const bool begins_beyond = is_beyond(known, from + t_min * way);
  if (inside.is_empty()) {
    if (begins_beyond) return false;
    inside.end = t_min;
  }
  if (begins_beyond) t_min = border(known, from, way, inside.begin, t_min);
  if (is_beyond(known, from + t_max * way)) t_max = border(known, from, way, inside.end, t_max);
  return true;
}

/// The border between a parameter in the room and one beyond, on the side of the first.
double ContactTriangles::border(const KnownFace& known, Vec3 from, Vec3 way, double inside,
                                double beyond) const noexcept {
  const double close = k_border * tolerance_m() / norm(way);
  while (std::abs(beyond - inside) > close) {
    const double middle = 0.5 * (inside + beyond);
    (is_beyond(known, from + middle * way) ? beyond : inside) = middle;
  }
  return inside;
}

/// The corner of a triangle that does not lie on the edge to another one.
Vec3 ContactTriangles::opposite(std::uint32_t place, std::uint32_t other) const noexcept {
  return corner(place, (edge_towards(place, other) + 2) % 3);
}

}  // namespace papilla
