// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/pipeline/object_texture_rules.hpp"

namespace papilla {

/// A rectangle with a picture, in the coordinates of what it stands for.
struct CarrierFrame {
  Vec3 middle;
  ProjectorAxes axes;  ///< `forward` goes into the picture: its front looks against it.
  double width_mm = 0, height_mm = 0;

  Vec3 corner(double x, double y) const { return middle + x * width_mm * axes.right + y * height_mm * axes.up; }
};

/// What is known of a carrier that is fitted, in the coordinates of the mesh.
struct CarrierWish {
  std::optional<Vec3> direction;  ///< Of the look at it.
  Vec3 up;                        ///< As far as it is across.
  Vec3 seen_from;                 ///< Which side is the front where the triangles do not tell.
};

/// The plane through the centroid of the triangles' area along which their second moments are largest, or the one
/// across the direction, and in it the rectangle around them. Its front is where the area looks on the whole
/// (|Σ A n| > Σ A / 1000), or else where it is seen from.
/// @throws InvalidInput when they have no area.
CarrierFrame fit_carrier(const TriangleMesh& mesh, const std::vector<Index>& triangles, const CarrierWish& wish);

/// Two triangles with uv (0, 0) to (1, 1) and one normal, of slot 0.
TriangleMesh carrier_mesh(const CarrierFrame& frame);

}  // namespace papilla
