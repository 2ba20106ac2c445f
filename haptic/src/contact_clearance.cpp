// SPDX-License-Identifier: MIT
#include <algorithm>

#include "contact_triangles.hpp"

namespace papilla {
namespace {

constexpr double k_above = 1 - 1e-6;  // Cosine of 1.4 mrad: closer to the normal counts as above the face.
constexpr double k_level = 1e-6;      // Square of a slope below which the closest point moves by 1/1000 of the skin.

}  // namespace

/// Upper bound of the relief of a triangle above its base.
double ContactTriangles::relief_top(std::uint32_t place) const noexcept {
  if (!has_relief(place)) return 0;
  const auto& height = materials_[material_of(place)].height;
  const float lowest = std::min({relief(place, 0).shift, relief(place, 1).shift, relief(place, 2).shift});
  return std::max(0.0, (height ? heights_[*height].max_m() : 0.0) - static_cast<double>(lowest));
}

ContactTriangles::Face ContactTriangles::face(std::uint32_t place) const noexcept {
  Face face;
  face.t = corners(place);
  face.ab = face.t.b - face.t.a;
  face.ac = face.t.c - face.t.a;
  face.normal = normalized(cross(face.ab, face.ac));
  face.ab_ab = dot(face.ab, face.ab);
  face.ab_ac = dot(face.ab, face.ac);
  face.ac_ac = dot(face.ac, face.ac);
  const double det = face.ab_ab * face.ac_ac - face.ab_ac * face.ab_ac;
  if (det > 0) face.inverse_det = 1 / det;
  face.has_relief = has_relief(place);
  if (!face.has_relief) return face;

  if (const auto& height = materials_[material_of(place)].height) face.height = &heights_[*height];
  const auto uv = [&](std::size_t k) {
    return Vec2{static_cast<double>(relief(place, k).u), static_cast<double>(relief(place, k).v)};
  };
  const auto shift = [&](std::size_t k) { return static_cast<double>(relief(place, k).shift); };
  if (face.height != nullptr) {
    const auto [per_u, per_v] = face.height->texels_per_uv();
    const Vec2 uv_v = uv(1) - uv(0), uv_w = uv(2) - uv(0);
    face.texel = face.height->texel_at(uv(0));
    face.texel_v = uv_v.x * per_u + uv_v.y * per_v;
    face.texel_w = uv_w.x * per_u + uv_w.y * per_v;
  }
  face.shift = shift(0);
  face.shift_v = shift(1) - face.shift;
  face.shift_w = shift(2) - face.shift;
  face.top = relief_top(place);
  const Vec2 steep = face.height != nullptr ? face.height->steepest_m() : Vec2{};
  const Vec3 by_x = steep.x * face.in_plane(face.texel_v.x, face.texel_w.x),
             by_y = steep.y * face.in_plane(face.texel_v.y, face.texel_w.y);
  face.steepest = std::sqrt(dot(by_x, by_x) + dot(by_y, by_y) + 2 * std::abs(dot(by_x, by_y))) +
                  norm(face.in_plane(face.shift_v, face.shift_w));
  return face;
}

/// The relief with the skin on it along its normal, less the skin. Above the foot c it is touched at
/// c + s·∇h/√(1 + |∇h|²), where ∇h is the slope of the relief; with the height at c alone the closest point of a curved
/// relief would be off by the slope times the skin.
[[gnu::always_inline]] inline ContactTriangles::ReliefSample ContactTriangles::skinned_relief_at(
    const Face& face, Vec2 weights) const noexcept {
  const ReliefSample at = relief_at(face, weights);
  if (!(at.steep > k_level)) return at;
  ReliefSample touched = relief_at(face, weights + (skin_ / std::sqrt(1 + at.steep)) * at.slope);
  touched.height = std::max(0.0, touched.height + skin_ / std::sqrt(1 + touched.steep) - skin_);
  return touched;
}

/// The clearance of a place straight above or below the face, at a height along its normal.
[[gnu::always_inline]] inline ContactTriangles::Clearance ContactTriangles::clearance_above(
    const Face& face, Vec2 weights, double height) const noexcept {
  Clearance result;
  result.d = height * face.normal;
  result.distance = std::abs(height);
  result.value = result.distance - contact_radius_m();
  result.gradient = height < 0 ? -face.normal : face.normal;
  if (!face.has_relief) return result;
  if (height < 0) {
    result.lift = face.top;
    return result;
  }
  const ReliefSample relief = skinned_relief_at(face, weights);
  result.lift = relief.height;
  result.value -= relief.height;
  result.gradient = result.gradient - face.vector_of(relief.slope);
  return result;
}

/// The clearance of a place whose closest point lies on an edge or a corner.
ContactTriangles::Clearance ContactTriangles::clearance_beside(const Face& face, Vec3 x) const noexcept {
  const Foot f = foot(face.t, x);
  Clearance result;
  result.d = x - f.point;
  result.distance = norm(result.d);
  const double contact = contact_radius_m();
  if (result.distance == 0) {
    result.gradient = face.normal;
    result.value = -contact;
    return result;
  }
  const Vec3 out = (1 / result.distance) * result.d;
  result.gradient = out;
  result.value = result.distance - contact;
  if (!face.has_relief) return result;

  double cosine = dot(face.normal, out);
  if (cosine <= 0) {
    result.lift = face.top;
    return result;
  }
  cosine = f.on == Foot::On::face ? 1 : std::min(1.0, cosine);
  const ReliefSample relief = skinned_relief_at(face, {f.v, f.w});
  Vec3 slope = face.vector_of(relief.slope);
  result.lift = relief.height;
  result.value -= cosine * result.lift;
  // For x outside the face's prism the foot moves along the edge only, or not at all. Right above the edge it moves in
  // both directions, as a neighbour continues there.
  const bool above = f.on == Foot::On::face || cosine > k_above;
  if (f.on == Foot::On::edge && !above) slope = (dot(slope, f.edge) / dot(f.edge, f.edge)) * f.edge;
  if (f.on != Foot::On::corner || above) result.gradient = result.gradient - cosine * slope;
  return result;
}

ContactTriangles::Clearance ContactTriangles::clearance_of(const Face& face, Vec3 x) const noexcept {
  const Vec3 from_a = x - face.t.a;
  const Vec2 weights = face.weights_of(from_a);
  const bool covered = face.inverse_det > 0 && weights.x >= 0 && weights.y >= 0 && weights.x + weights.y <= 1;
  return covered ? clearance_above(face, weights, dot(face.normal, from_a)) : clearance_beside(face, x);
}

}  // namespace papilla
