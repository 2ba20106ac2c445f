// SPDX-License-Identifier: MIT
#include "real_surface.hpp"

#include <array>
#include <cmath>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/haptic/stroke.hpp"
#include "workspace.hpp"

namespace papilla::player {
namespace {

constexpr double k_farthest_m = 0.01;  // Of a point of the part from its surface.
constexpr double k_most_residual_m = 2e-3;

std::array<Vec3, 3> points_of(const std::vector<double>& values) {
  const auto point = [&](std::size_t i) { return Vec3{values[3 * i], values[3 * i + 1], values[3 * i + 2]}; };
  return {point(0), point(1), point(2)};
}

/// Centre of the tip that touches the surface where a point lies.
Vec3 tip_at(const ContactSurface& surface, Vec3 point, const char* what) {
  const auto near = surface.closest_point(point, k_farthest_m + surface.tallest_relief_m());
  if (!near) throw InvalidInput(std::string(what) + ": lies farther than 10 mm from the surfaces of the scene");
  return near->point + (surface.probe_radius_m() - near->base_m) * near->face_normal;
}

Registration of_plane(const RealSurface& real, const HapticScene& scene, const ContactSurface& surface) {
  constexpr const char* k_what = "--surface real";
  const SurfacePoint middle = middle_of_largest(scene, surface, k_what);
  const Vec3 n = middle.face_normal;
  const Vec3 along = std::abs(n.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return register_plane(points_of(real.touched), tip_at(surface, middle.point, k_what), n, along);
}

}  // namespace

Registration register_part(const RealSurface& real, const HapticScene& scene, const ContactSurface& surface) {
  if (real.part_points.empty()) return of_plane(real, scene, surface);
  std::array<Vec3, 3> of_part = points_of(real.part_points);
  for (Vec3& point : of_part) point = tip_at(surface, point, "--part-points");
  const Registration found = register_points(points_of(real.touched), of_part);
  if (found.residual_m > k_most_residual_m)
    throw InvalidInput("--touched: the points lie " + std::to_string(1e3 * found.residual_m) +
                       " mm (rms) from --part-points; are they in the same order, and of this part?");
  return found;
}

}  // namespace papilla::player
