// SPDX-License-Identifier: MIT
#include <algorithm>

#include "contact_triangle.hpp"

namespace papilla {
namespace {

constexpr double k_above = 1 - 1e-6;  // Cosine of less than 1.5 mrad off a triangle's normal.
constexpr double k_level = 1e-6;      // Square of a slope that moves the nearest point by a thousandth of the skin.

}  // namespace

/// The highest that the relief of a triangle can be above its base.
double ContactSurface::top_of(std::uint32_t place) const noexcept {
  if (!has_relief(place)) return 0;
  const auto& height = materials_[material_of(place)].height;
  const float lowest = std::min({relief(place, 0).shift, relief(place, 1).shift, relief(place, 2).shift});
  return std::max(0.0, (height ? heights_[*height].max_m() : 0.0) - static_cast<double>(lowest));
}

/// Weights of b and c of a way within the triangle's plane; zero on a needle.
Vec2 ContactSurface::weights_of(const Corners& t, Vec3 way) noexcept {
  const Vec3 ab = t.b - t.a, ac = t.c - t.a;
  const double aa = dot(ab, ab), bb = dot(ac, ac), c = dot(ab, ac), det = aa * bb - c * c;
  if (!(det > 0)) return {};
  const double p = dot(way, ab), q = dot(way, ac);
  return {(p * bb - q * c) / det, (q * aa - p * c) / det};
}

/// ∇h = (∂h/∂v) ∇v + (∂h/∂w) ∇w with the gradients of the barycentric weights in the plane; zero on a needle.
Vec3 ContactSurface::in_plane(const Corners& t, double by_v, double by_w) noexcept {
  const Vec3 ab = t.b - t.a, ac = t.c - t.a;
  const double aa = dot(ab, ab), bb = dot(ac, ac), c = dot(ab, ac), det = aa * bb - c * c;
  if (!(det > 0)) return {};
  return (1 / det) * ((by_v * bb - by_w * c) * ab + (by_w * aa - by_v * c) * ac);
}

/// Height of the relief above the base at a foot, and its gradient within the triangle's plane.
double ContactSurface::relief_at(std::uint32_t place, const Corners& t, const Foot& foot,
                                 Vec3* gradient) const noexcept {
  const auto corner = [&](std::size_t k) {
    return Vec2{static_cast<double>(relief(place, k).u), static_cast<double>(relief(place, k).v)};
  };
  const auto shift = [&](std::size_t k) { return static_cast<double>(relief(place, k).shift); };
  const double s0 = shift(0), sv = shift(1) - s0, sw = shift(2) - s0;
  const Vec2 by_v = corner(1) - corner(0), by_w = corner(2) - corner(0);
  HeightSample sample;
  if (const auto& height = materials_[material_of(place)].height)
    sample = heights_[*height].sample(corner(0) + foot.v * by_v + foot.w * by_w);
  const double height = sample.height_m - (s0 + foot.v * sv + foot.w * sw);
  if (gradient == nullptr) return std::max(0.0, height);
  *gradient = {};
  if (height <= 0) return 0;
  *gradient = in_plane(t, dot(sample.gradient_m, by_v) - sv, dot(sample.gradient_m, by_w) - sw);
  return height;
}

/// The relief with the skin on it along its normal, less the skin: how much farther than over the base a probe above
/// the foot stands. Touched there is the point c + s·∇h/√(1 + |∇h|²) of a relief with a slope ∇h. By the height alone
/// the nearest point of a curved relief would move by the slope times the skin.
double ContactSurface::lift_at(std::uint32_t place, const Corners& t, const Foot& foot, Vec3* slope) const noexcept {
  const double height = relief_at(place, t, foot, slope);
  const double steep = dot(*slope, *slope);
  if (!(steep > k_level)) return height;
  const Vec2 way = weights_of(t, (skin_ / std::sqrt(1 + steep)) * *slope);
  Foot touched = foot;
  touched.v += way.x;
  touched.w += way.y;
  const double there = relief_at(place, t, touched, slope);
  return std::max(0.0, there + skin_ / std::sqrt(1 + dot(*slope, *slope)) - skin_);
}

ContactSurface::Clearance ContactSurface::clearance_of(std::uint32_t place, const Corners& t, Vec3 x) const noexcept {
  const Foot f = foot(t, x);
  const Vec3 d = x - f.point;
  Clearance result;
  result.distance = norm(d);
  const double contact = contact_radius_m();
  if (result.distance == 0) {
    result.gradient = normalized(cross(t.b - t.a, t.c - t.a));
    result.value = -contact;
    return result;
  }
  const Vec3 out = (1 / result.distance) * d;
  result.gradient = out;
  result.value = result.distance - contact;
  if (!has_relief(place)) return result;

  const Vec3 area = cross(t.b - t.a, t.c - t.a);
  double cosine = dot(area, out);
  if (cosine <= 0) return result;
  cosine = f.on == Foot::On::face ? 1 : std::min(1.0, cosine / norm(area));
  Vec3 slope;
  result.value -= cosine * lift_at(place, t, f, &slope);
  // Beside the triangle the foot moves along its edge only, or not at all. Right above the edge it moves both ways:
  // there a neighbour goes on.
  const bool above = f.on == Foot::On::face || cosine > k_above;
  if (f.on == Foot::On::edge && !above) slope = (dot(slope, f.edge) / dot(f.edge, f.edge)) * f.edge;
  if (f.on != Foot::On::corner || above) result.gradient = result.gradient - cosine * slope;
  return result;
}

}  // namespace papilla
