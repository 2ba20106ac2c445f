// SPDX-License-Identifier: MIT
#include "face_surface.hpp"

namespace papilla::cad {

SurfaceSample FaceSurface::at(Vec2 uv) const {
  gp_Pnt p;
  gp_Vec du, dv;
  surface_.D1(uv.x, uv.y, p, du, dv);
  SurfaceSample sample{to_vec(p.XYZ()), to_vec(du.XYZ()), to_vec(dv.XYZ()), {}};
  const Vec3 n = cross(sample.du, sample.dv);
  // Below this sine the tangents are parallel for all that double precision can tell.
  constexpr double k_parallel = 1e-9;
  if (norm(n) > k_parallel * norm(sample.du) * norm(sample.dv)) sample.normal = normalized(n);
  return sample;
}

Vec3 FaceSurface::point(Vec2 uv) const { return to_vec(surface_.Value(uv.x, uv.y).XYZ()); }

}  // namespace papilla::cad
