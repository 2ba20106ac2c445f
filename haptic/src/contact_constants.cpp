// SPDX-License-Identifier: MIT
#include <algorithm>

#include "contact_triangles.hpp"

namespace papilla {
namespace {

/// The vector g in the plane of two edges with g·ab = by_v and g·ac = by_w.
Vec3 slope_in_plane(Vec3 ab, Vec3 ac, double by_v, double by_w) noexcept {
  const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), det = bb * cc - bc * bc;
  if (!(det > 0)) return {};
  return ((by_v * cc - by_w * bc) / det) * ab + ((by_w * bb - by_v * bc) / det) * ac;
}

}  // namespace

double ContactSurface::most(std::uint32_t i, Quantity quantity) const noexcept {
  const ContactMaterial& m = triangles_->material(i);
  if (m.channels)
    if (const auto most = triangles_->channels(*m.channels).most(quantity)) return *most;
  switch (quantity) {
    case Quantity::stiffness: return m.stiffness;
    case Quantity::static_friction: return m.static_friction;
    case Quantity::dynamic_friction: return m.dynamic_friction;
    case Quantity::damping: break;
  }
  return m.damping;
}

LocalConstants ContactTriangles::constants_at(std::uint32_t place, Vec3 x) const noexcept {
  const ContactMaterial& m = material(material_of(place));
  LocalConstants local{m, {}};
  if (!m.channels) return local;
  const Corners t = corners(place);
  const Foot at = foot(t, x - origin_);
  const auto uv = [&](std::size_t k) {
    return Vec2{static_cast<double>(relief(place, k).u), static_cast<double>(relief(place, k).v)};
  };
  const Vec2 by_v = uv(1) - uv(0), by_w = uv(2) - uv(0);
  const Vec2 gradient = channels_[*m.channels].apply(uv(0) + at.v * by_v + at.w * by_w, local.constants);
  if (local.constants.stiffness > m.most_stiffness)
    local.constants.stiffness = m.most_stiffness;
  else if (!(gradient == Vec2{}))
    local.stiffness_slope = slope_in_plane(t.b - t.a, t.c - t.a, dot(gradient, by_v), dot(gradient, by_w));
  local.constants.damping = std::min(local.constants.damping, m.most_damping);
  return local;
}

}  // namespace papilla
