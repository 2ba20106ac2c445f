// SPDX-License-Identifier: MIT
#include "workspace.hpp"

#include "papilla/core/error.hpp"

namespace papilla::player {

namespace {
constexpr double k_clearance_m = 0.01;
}

SurfacePoint middle_of_largest(const HapticScene& scene, const ContactSurface& surface, const std::string& what) {
  const LargestMaterial largest = largest_material(scene);
  const double everywhere = norm(largest.centre - surface.low()) + norm(surface.high() - surface.low());
  const auto nearest = surface.closest_point(largest.centre, everywhere, largest.material);
  if (!nearest) throw InvalidInput(what + ": the largest material has no triangle");
  return *nearest;
}

Vec3 workspace_origin(std::span<const double> asked, const HapticScene& scene, const ContactSurface& surface,
                      const std::string& what) {
  if (!asked.empty()) return {asked[0], asked[1], asked[2]};
  const SurfacePoint middle = middle_of_largest(scene, surface, what);
  return middle.point + (k_clearance_m + middle.height_m + surface.probe_radius_m()) * middle.face_normal;
}

}  // namespace papilla::player
