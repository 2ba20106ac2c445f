// SPDX-License-Identifier: MIT
#include "face_surface.hpp"

#include <BRepTools.hxx>

#include <algorithm>
#include <cmath>

namespace papilla::cad {

FaceSurface::FaceSurface(const TopoDS_Face& face) : surface_(face, false) {
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  constexpr int k_grid = 4;
  for (int i = 0; i < k_grid; ++i)
    for (int k = 0; k < k_grid; ++k) {
      const SurfaceSample s = at({u0 + (i + 0.5) / k_grid * (u1 - u0), v0 + (k + 0.5) / k_grid * (v1 - v0)});
      if (const double length = norm(s.du); std::isfinite(length)) largest_du_ = std::max(largest_du_, length);
      if (const double length = norm(s.dv); std::isfinite(length)) largest_dv_ = std::max(largest_dv_, length);
    }
}

SurfaceSample FaceSurface::at(Vec2 uv) const {
  gp_Pnt p;
  gp_Vec du, dv;
  surface_.D1(uv.x, uv.y, p, du, dv);
  SurfaceSample sample{to_vec(p.XYZ()), to_vec(du.XYZ()), to_vec(dv.XYZ()), {}};
  const Vec3 n = cross(sample.du, sample.dv);
  // Below this sine the tangents are parallel for all that double precision can tell; below this part of their length
  // elsewhere, as at the pole of a sphere, their direction is rounding.
  constexpr double k_parallel = 1e-9;
  const double along_u = norm(sample.du), along_v = norm(sample.dv);
  if (norm(n) > k_parallel * along_u * along_v && along_u > k_parallel * largest_du_ &&
      along_v > k_parallel * largest_dv_)
    sample.normal = normalized(n);
  return sample;
}

Vec3 FaceSurface::point(Vec2 uv) const { return to_vec(surface_.Value(uv.x, uv.y).XYZ()); }

}  // namespace papilla::cad
