// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/io/haptic_scene.hpp"

namespace papilla::player {

/// The point of the largest tagged surface that is nearest to its centre.
/// @throws InvalidInput that begins with `what` when the surface has no triangle.
SurfacePoint middle_of_largest(const HapticScene& scene, const ContactSurface& surface, const std::string& what);

/// Centre of a real device's workspace: the three numbers of `asked`, or, when that is empty, where a probe is 10 mm
/// above the relief at middle_of_largest().
Vec3 workspace_origin(std::span<const double> asked, const HapticScene& scene, const ContactSurface& surface,
                      const std::string& what);

}  // namespace papilla::player
