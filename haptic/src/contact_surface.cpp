// SPDX-License-Identifier: MIT
#include "papilla/haptic/contact_surface.hpp"

#include <algorithm>
#include <cmath>

#include "contact_triangles.hpp"

namespace papilla {
namespace {

// Barycentric margin of crossings(), so that a crossing of a shared edge is found in one of its triangles at least.
constexpr double k_edge = 1e-9;
constexpr int k_most_crossings = 16;

/// The closest triangle and its foot.
struct Nearest {
  std::uint32_t place = 0xffffffffU;
  ContactTriangles::Foot foot;
  double distance;
};

/// Which triangles a search is for: of one material, or of those with a stimulus, or all.
struct Wanted {
  std::optional<std::uint32_t> material = {};
  bool stimulus = false;
};

/// The closest of the wanted triangles. The boxes of the tree are grown by the relief, so some are visited in vain.
std::optional<Nearest> find_nearest(const ContactTriangles& s, Vec3 x, double radius, const Wanted& wanted) noexcept {
  Nearest best{.foot = {}, .distance = radius};
  bool found = false;
  s.clusters().within(x, best.distance, [&](std::uint32_t cluster) noexcept {
    s.clusters().in_box(cluster, s.box_around(x, x, best.distance), [&](std::uint32_t place) noexcept {
      if (wanted.material && s.material_of(place) != *wanted.material) return;
      if (wanted.stimulus && !s.material(s.material_of(place)).stimulus) return;
      const auto foot = s.foot(s.corners(place), x);
      const double distance = norm(x - foot.point);
      if (distance > best.distance) return;
      best = {place, foot, distance};
      found = true;
    });
  });
  return found ? std::optional(best) : std::nullopt;
}

std::optional<SurfacePoint> closest_base_point(const ContactTriangles& s, Vec3 p, double radius_m,
                                               const Wanted& wanted) noexcept {
  const auto near = find_nearest(s, p - s.origin(), radius_m, wanted);
  if (!near) return std::nullopt;
  const auto t = s.corners(near->place);
  SurfacePoint point;
  point.point = near->foot.point + s.origin();
  point.face_normal = normalized(cross(t.b - t.a, t.c - t.a));
  point.distance_m = near->distance;
  if (s.has_relief(near->place)) {
    const auto face = s.face(near->place);
    const auto relief = s.relief_at(face, {near->foot.v, near->foot.w});
    point.height_m = relief.height;
    point.slope = face.vector_of(relief.slope);
    point.base_m = face.shift + near->foot.v * face.shift_v + near->foot.w * face.shift_w;
  }
  point.on_border = near->foot.on != ContactTriangles::Foot::On::face;
  point.triangle = s.source_of(near->place);
  point.material = s.material_of(near->place);
  return point;
}

}  // namespace

ContactSurface::ContactSurface(const ContactMesh& mesh, std::vector<ContactMaterial> materials,
                               std::vector<HeightField> heights, double probe_radius_m,
                               std::vector<ChannelField> channels)
    : triangles_(std::make_unique<ContactTriangles>(mesh, std::move(materials), std::move(heights), probe_radius_m,
                                                    std::move(channels))) {}
ContactSurface::ContactSurface(ContactSurface&&) noexcept = default;
ContactSurface& ContactSurface::operator=(ContactSurface&&) noexcept = default;
ContactSurface::~ContactSurface() = default;

std::optional<SweepHit> ContactSurface::sweep(Vec3 from, Vec3 to) const noexcept { return triangles_->sweep(from, to); }

Vec3 ContactSurface::shaded_normal(Vec3 proxy, Vec3 normal) const noexcept {
  return triangles_->shaded_normal(proxy, normal);
}

std::optional<SurfacePoint> ContactSurface::closest_point(Vec3 p, double radius_m) const noexcept {
  return closest_base_point(*triangles_, p, radius_m, {});
}

std::optional<SurfacePoint> ContactSurface::closest_point(Vec3 p, double radius_m,
                                                          std::uint32_t material) const noexcept {
  return closest_base_point(*triangles_, p, radius_m, {.material = material});
}

std::optional<StimulusSample> ContactSurface::stimulus(Vec3 p, double radius_m) const noexcept {
  const ContactTriangles& s = *triangles_;
  const auto near = find_nearest(s, p - s.origin(), radius_m, {.stimulus = true});
  if (!near) return std::nullopt;
  const std::uint32_t found = near->place;
  const auto& at = near->foot;
  const auto f = s.face(found);
  const HeightField& field = s.height(*s.material(s.material_of(found)).stimulus);
  const auto uv = [&](std::size_t k) {
    return Vec2{static_cast<double>(s.relief(found, k).u), static_cast<double>(s.relief(found, k).v)};
  };
  const Vec2 by_v = uv(1) - uv(0), by_w = uv(2) - uv(0);
  const Vec2 here = uv(0) + at.v * by_v + at.w * by_w;
  const HeightSample height = field.sample(here);
  const auto texels = field.texels_per_uv();
  const double texel_area =
      std::abs(cross(by_v.x * texels[0] + by_v.y * texels[1], by_w.x * texels[0] + by_w.y * texels[1]));
  StimulusSample sample;
  sample.normal = f.normal;
  sample.column = here.x * texels[0].x + here.y * texels[1].x;
  sample.grey = field.greys_per_m() * height.height_m;
  sample.slope = field.greys_per_m() * f.in_plane(dot(height.gradient_m, by_v), dot(height.gradient_m, by_w));
  sample.along_u = normalized(f.in_plane(by_v.x, by_w.x));
  sample.pixel_m = texel_area > 0 ? std::sqrt(norm(cross(f.ab, f.ac)) / texel_area) : 0;
  sample.material = s.material_of(found);
  return sample;
}

int ContactSurface::crossings(Vec3 from, Vec3 to) const noexcept {
  const ContactTriangles& s = *triangles_;
  const Vec3 start = from - s.origin(), way = to - from;
  double parameters[k_most_crossings];
  int count = 0;
  double t_max = 1;
  const Box3f box = s.box_around(start, start + way, 0);
  s.clusters().along(start, way, 0, t_max, [&](std::uint32_t cluster) noexcept {
    s.clusters().in_box(cluster, box, [&](std::uint32_t place) noexcept {
      const auto t = s.corners(place);
      const Vec3 ab = t.b - t.a, ac = t.c - t.a, p = cross(way, ac);
      const double det = dot(ab, p);
      if (det == 0 || count == k_most_crossings) return;
      const Vec3 from_a = start - t.a, q = cross(from_a, ab);
      const double u = dot(from_a, p) / det, v = dot(way, q) / det, at = dot(ac, q) / det;
      if (u < -k_edge || v < -k_edge || u + v > 1 + k_edge || at < 0 || at >= 1) return;
      const bool known = std::any_of(parameters, parameters + count,
                                     [at](double other) noexcept { return std::abs(at - other) < k_edge; });
      if (!known) parameters[count++] = at;
    });
  });
  return count;
}

double ContactSurface::clearance(Vec3 x, double radius_m) const noexcept {
  const ContactTriangles& s = *triangles_;
  const Vec3 y = x - s.origin();
  double least = radius_m - contact_radius_m(), reach = radius_m;
  s.clusters().within(y, reach, [&](std::uint32_t cluster) noexcept {
    s.clusters().in_box(cluster, s.box_around(y, y, reach), [&](std::uint32_t place) noexcept {
      const ContactTriangles::KnownFace known = s.known_face(place);
      const double of_triangle = s.clearance_of(known.face, y).value;
      if (of_triangle < least && !s.is_beyond(known, y)) least = of_triangle;
    });
    // Boxes include the relief: triangles farther than least + r + s from their box have more clearance than `least`.
    reach = std::min(reach, std::max(0.0, least + contact_radius_m()));
  });
  return least;
}

const ContactMaterial& ContactSurface::material(std::uint32_t i) const noexcept { return triangles_->material(i); }
ContactMaterial& ContactSurface::material(std::uint32_t i) noexcept { return triangles_->material(i); }
std::size_t ContactSurface::material_count() const noexcept { return triangles_->material_count(); }
std::size_t ContactSurface::triangles() const noexcept { return triangles_->clusters().triangles(); }
std::size_t ContactSurface::skipped_triangles() const noexcept { return triangles_->skipped(); }
double ContactSurface::probe_radius_m() const noexcept { return triangles_->probe_radius_m(); }
double ContactSurface::skin_m() const noexcept { return triangles_->skin_m(); }
double ContactSurface::tallest_relief_m() const noexcept { return triangles_->tallest_relief_m(); }
Vec3 ContactSurface::low() const noexcept { return triangles_->low(); }
Vec3 ContactSurface::high() const noexcept { return triangles_->high(); }
std::size_t ContactSurface::bytes() const noexcept { return triangles_->bytes(); }

std::size_t ContactTriangles::bytes() const noexcept {
  return clusters_.bytes() + material_.size() * (sizeof(material_[0]) + sizeof(source_[0])) +
         continued_.size() * (sizeof(continued_[0]) + sizeof(arch_[0])) + normals_.size() * sizeof(normals_[0]);
}

}  // namespace papilla
