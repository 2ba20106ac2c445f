// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "papilla/haptic/contact_surface.hpp"

namespace papilla {
namespace contact_detail {

inline Vec3 point_of(const std::array<float, 3>& v) noexcept {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

}  // namespace contact_detail

/// Nearest point of a triangle: barycentric weights of b and c, and what part of the triangle it lies on.
struct ContactSurface::Foot {
  Vec3 point;
  double v = 0, w = 0;
  enum class On { face, edge, corner } on = On::face;
  Vec3 edge;  ///< Direction, when on an edge; not normalised.
};

/// A moving probe at t, and where it stands to a triangle.
struct ContactSurface::Approach {
  double t = 0, distance = 0;
  Vec3 d;              ///< From the nearest point.
  bool above = false;  ///< That is within the face.
};

/// f_T and its gradient (not normalised).
struct ContactSurface::Clearance {
  double value = 0;
  double distance = 0;
  Vec3 d;           ///< From the nearest point.
  double lift = 0;  ///< Of the relief there; at most, where the triangle is seen from behind.
  Vec3 gradient;
};

/// A triangle with what is needed to look at its clearance in many places.
struct ContactSurface::Face {
  Corners t;
  Vec3 ab, ac, normal;                                      ///< Zero on a needle, as inverse_det is.
  double ab_ab = 0, ab_ac = 0, ac_ac = 0, inverse_det = 0;  ///< Of the edges' products.
  bool has_relief = false;
  const HeightField* height = nullptr;
  Vec2 uv, uv_v, uv_w;                         ///< At a, and how they change with the weights of b and c.
  double shift = 0, shift_v = 0, shift_w = 0;  ///< The same of the base.
  double top = 0;                              ///< The highest that the relief can be above the base.

  /// Weights of b and c of a way within the triangle's plane; zero on a needle.
  Vec2 weights_of(Vec3 way) const noexcept {
    const double p = dot(way, ab), q = dot(way, ac);
    return inverse_det * Vec2{p * ac_ac - q * ab_ac, q * ab_ab - p * ab_ac};
  }
  /// ∇h = (∂h/∂v) ∇v + (∂h/∂w) ∇w with the gradients of the barycentric weights in the plane; zero on a needle.
  Vec3 in_plane(double by_v, double by_w) const noexcept {
    return inverse_det * ((by_v * ac_ac - by_w * ab_ac) * ab + (by_w * ab_ab - by_v * ab_ac) * ac);
  }
};

inline ContactSurface::Corners ContactSurface::corners(std::uint32_t place) const noexcept {
  using contact_detail::point_of;
  return {point_of(clusters_.corner(place, 0)), point_of(clusters_.corner(place, 1)),
          point_of(clusters_.corner(place, 2))};
}

/// The box of all that lies within `reach` of the way from a to b, rounded outwards.
inline Box3f ContactSurface::box_around(Vec3 a, Vec3 b, double reach) noexcept {
  const double size =
      std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z), std::abs(b.x), std::abs(b.y), std::abs(b.z)});
  const double grow = reach + 2 * static_cast<double>(std::numeric_limits<float>::epsilon()) * (size + reach);
  const auto low = [grow](double x, double y) { return static_cast<float>(std::min(x, y) - grow); };
  const auto high = [grow](double x, double y) { return static_cast<float>(std::max(x, y) + grow); };
  Box3f box;
  box.low = {low(a.x, b.x), low(a.y, b.y), low(a.z, b.z)};
  box.high = {high(a.x, b.x), high(a.y, b.y), high(a.z, b.z)};
  return box;
}

/// Ericson, Real-Time Collision Detection (2005), 5.1.5: by the Voronoi region that x lies in.
[[gnu::always_inline]] inline ContactSurface::Foot ContactSurface::foot(const Corners& t, Vec3 x) noexcept {
  const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = x - t.a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {t.a, 0, 0, Foot::On::corner, {}};
  const Vec3 bp = x - t.b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {t.b, 1, 0, Foot::On::corner, {}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {t.a + v * ab, v, 0, Foot::On::edge, ab};
  }
  const Vec3 cp = x - t.c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {t.c, 0, 1, Foot::On::corner, {}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {t.a + w * ac, 0, w, Foot::On::edge, ac};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {t.b + w * (t.c - t.b), 1 - w, w, Foot::On::edge, t.c - t.b};
  }
  const double scale = 1 / (va + vb + vc), v = vb * scale, w = vc * scale;
  return {t.a + v * ab + w * ac, v, w, Foot::On::face, {}};
}

}  // namespace papilla
