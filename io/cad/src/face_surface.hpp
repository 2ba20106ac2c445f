// SPDX-License-Identifier: MIT
#pragma once

#include <BRepAdaptor_Surface.hxx>
#include <TopoDS_Face.hxx>

#include "papilla/core/vec.hpp"

namespace papilla::cad {

/// A point of a CAD surface and its frame, in the frame of the shape.
struct SurfaceSample {
  Vec3 point;
  Vec3 du, dv;
  Vec3 normal;  ///< du × dv of unit length; zero where the tangents are parallel or one of them vanishes.
};

/// The exact surface below a face as a function of its parameters. Not for several threads at once: the library keeps
/// the last B-spline span in it.
class FaceSurface {
 public:
  explicit FaceSurface(const TopoDS_Face& face);

  SurfaceSample at(Vec2 uv) const;
  Vec3 point(Vec2 uv) const;
  bool is_plane() const { return surface_.GetType() == GeomAbs_Plane; }
  /// Plane, cylinder, cone, sphere or torus.
  bool is_elementary() const { return surface_.GetType() <= GeomAbs_Torus; }

 private:
  BRepAdaptor_Surface surface_;
  double largest_du_ = 0, largest_dv_ = 0;  ///< On a grid over the face.
};

inline Vec3 to_vec(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

}  // namespace papilla::cad
