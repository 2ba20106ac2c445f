// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "papilla/core/bounds.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/pipeline/object_texture_rules.hpp"

namespace papilla {

/// Coordinates in which a projector's box is the unit cube: to the right, up, and along the projection.
class BoxFrame {
 public:
  /// @throws InvalidInput as projector_axes().
  explicit BoxFrame(const ProjectorBox& box) : BoxFrame(box, projector_axes(box.direction, box.up)) {}
  Vec3 to_box(Vec3 p) const noexcept;
  const ProjectorAxes& axes() const noexcept { return axes_; }

 private:
  BoxFrame(const ProjectorBox& box, const ProjectorAxes& axes) : box_(box), axes_(axes) {}
  ProjectorBox box_;
  ProjectorAxes axes_;
};

/// A corner of a clipped triangle: barycentric weights in the triangle, and the place in the box.
struct ClippedCorner {
  std::array<double, 3> weights{};
  Vec3 box;
};

/// The part of a triangle within the unit cube, a convex polygon of 0 or 3 to 9 corners in the triangle's sense
/// [Sutherland and Hodgman, Reentrant polygon clipping, 1974]. Coordinates cut at a face are 0 or 1 exactly; two
/// triangles with the same edge get the same corners on it, bit for bit.
std::vector<ClippedCorner> clip_to_unit_cube(const std::array<Vec3, 3>& corners);

/// Whether what lies in `part`, shown with `world`, may reach into the box: false is certain, also where it was rounded
/// to single precision.
bool may_meet(const Bounds3& part, const Transform& world, const BoxFrame& frame);

/// Whether all of a triangle lies in the box. @param world  of the use.
bool is_within(const TriangleMesh& mesh, Index triangle, const Transform& world, const BoxFrame& frame) noexcept;

/// What of a surface lies in a box.
struct DecalPatch {
  TriangleMesh mesh;           ///< In the surface's own coordinates, uv in [0, 1]; slots as in the surface.
  double area_mm2 = 0;         ///< In the scene.
  std::size_t turned_off = 0;  ///< Triangles in the box that are turned away too far.
};

/// The triangles of `slots` within the box and turned towards it by less than `max_angle_deg`, moved by `offset_mm`
/// against the projection. @param world  of the use. @pre world is invertible.
DecalPatch cut_decal(const TriangleMesh& mesh, const std::vector<std::uint32_t>& slots, const Transform& world,
                     const BoxFrame& frame, double max_angle_deg, double offset_mm);

}  // namespace papilla
