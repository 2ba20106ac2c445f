// SPDX-License-Identifier: MIT
#include "papilla/haptic/contact_surface.hpp"

#include <algorithm>
#include <cmath>

#include "contact_triangle.hpp"

namespace papilla {
namespace {

// Share of a triangle by which a way may miss it in crossings(), so that an edge is met from one side at least.
constexpr double k_edge = 1e-9;

}  // namespace

/// The triangle that comes nearest, and where.
struct ContactSurface::Nearest {
  std::uint32_t place;
  Foot foot;
  double distance;
};

std::size_t ContactSurface::bytes() const noexcept {
  return clusters_.bytes() + material_.size() * (sizeof(material_[0]) + sizeof(source_[0])) +
         normals_.size() * sizeof(normals_[0]);
}

/// The tree's boxes are grown by the relief, which only makes them visited earlier.
template <class Accept>
std::optional<ContactSurface::Nearest> ContactSurface::nearest(Vec3 x, double radius, Accept&& accept) const noexcept {
  Nearest best{k_nothing, {}, radius};
  clusters_.within(x, best.distance, [&](std::uint32_t cluster) noexcept {
    clusters_.in_box(cluster, box_around(x, x, best.distance), [&](std::uint32_t place) noexcept {
      if (!accept(material_of(place))) return;
      const Foot f = foot(corners(place), x);
      const double distance = norm(x - f.point);
      if (distance <= best.distance) best = {place, f, distance};
    });
  });
  return best.place == k_nothing ? std::nullopt : std::optional(best);
}

std::optional<SurfacePoint> ContactSurface::surface_point(const std::optional<Nearest>& near) const noexcept {
  if (!near) return std::nullopt;
  const Corners t = corners(near->place);
  SurfacePoint point;
  point.point = near->foot.point + origin_;
  point.face_normal = normalized(cross(t.b - t.a, t.c - t.a));
  point.distance_m = near->distance;
  point.height_m = has_relief(near->place) ? relief_at(face(near->place), near->foot, nullptr) : 0;
  point.on_border = near->foot.on != Foot::On::face;
  point.triangle = source_of(near->place);
  point.material = material_of(near->place);
  return point;
}

std::optional<SurfacePoint> ContactSurface::closest_point(Vec3 p, double radius_m) const noexcept {
  return surface_point(nearest(p - origin_, radius_m, [](std::uint32_t) noexcept { return true; }));
}

std::optional<SurfacePoint> ContactSurface::closest_point(Vec3 p, double radius_m,
                                                          std::uint32_t material) const noexcept {
  return surface_point(
      nearest(p - origin_, radius_m, [material](std::uint32_t other) noexcept { return other == material; }));
}

std::optional<StimulusSample> ContactSurface::stimulus(Vec3 p, double radius_m) const noexcept {
  const auto near = nearest(p - origin_, radius_m,
                            [&](std::uint32_t material) noexcept { return materials_[material].stimulus.has_value(); });
  if (!near) return std::nullopt;
  const std::uint32_t found = near->place;
  const Foot& at = near->foot;
  const Face f = face(found);
  const HeightField& field = heights_[*materials_[material_of(found)].stimulus];
  const auto uv = [&](std::size_t k) {
    return Vec2{static_cast<double>(relief(found, k).u), static_cast<double>(relief(found, k).v)};
  };
  const Vec2 by_v = uv(1) - uv(0), by_w = uv(2) - uv(0);
  const HeightSample height = field.sample(uv(0) + at.v * by_v + at.w * by_w);
  const auto texels = field.texels_per_uv();
  const double texel_area =
      std::abs(cross(by_v.x * texels[0] + by_v.y * texels[1], by_w.x * texels[0] + by_w.y * texels[1]));
  StimulusSample sample;
  sample.point = at.point + origin_;
  sample.normal = f.normal;
  sample.height_m = height.height_m;
  sample.grey = field.greys_per_m() * height.height_m;
  sample.slope = field.greys_per_m() * f.in_plane(dot(height.gradient_m, by_v), dot(height.gradient_m, by_w));
  sample.along_u = normalized(f.in_plane(by_v.x, by_w.x));
  sample.pixel_m = texel_area > 0 ? std::sqrt(norm(cross(f.ab, f.ac)) / texel_area) : 0;
  sample.material = material_of(found);
  return sample;
}

int ContactSurface::crossings(Vec3 from, Vec3 to) const noexcept {
  constexpr int k_most = 16;
  const Vec3 start = from - origin_, way = to - from;
  double places[k_most];
  int count = 0;
  double t_max = 1;
  const Box3f box = box_around(start, start + way, 0);
  clusters_.along(start, way, 0, t_max, [&](std::uint32_t cluster) noexcept {
    clusters_.in_box(cluster, box, [&](std::uint32_t place) noexcept {
      const Corners t = corners(place);
      const Vec3 ab = t.b - t.a, ac = t.c - t.a, p = cross(way, ac);
      const double det = dot(ab, p);
      if (det == 0 || count == k_most) return;
      const Vec3 s = start - t.a, q = cross(s, ab);
      const double u = dot(s, p) / det, v = dot(way, q) / det, at = dot(ac, q) / det;
      if (u < -k_edge || v < -k_edge || u + v > 1 + k_edge || at < 0 || at >= 1) return;
      const bool known =
          std::any_of(places, places + count, [at](double other) noexcept { return std::abs(at - other) < k_edge; });
      if (!known) places[count++] = at;
    });
  });
  return count;
}

double ContactSurface::clearance(Vec3 x, double radius_m) const noexcept {
  const Vec3 y = x - origin_;
  double least = radius_m - contact_radius_m(), reach = radius_m;
  clusters_.within(y, reach, [&](std::uint32_t cluster) noexcept {
    clusters_.in_box(cluster, box_around(y, y, reach), [&](std::uint32_t place) noexcept {
      least = std::min(least, clearance_of(face(place), y).value);
    });
    // Boxes hold the relief: what is farther than least + r + s from the box has more clearance than `least`.
    reach = std::min(reach, std::max(0.0, least + contact_radius_m()));
  });
  return least;
}

}  // namespace papilla
