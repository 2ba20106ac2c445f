// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/trajectory.hpp"

namespace papilla {

/// Motion of a synthetic hand after it has pressed.
enum class Motion {
  stroke,  ///< Straight along the surface, reversed at its end.
  circle,  ///< Along a circle of radius circle_m on the surface.
  slide,   ///< A smooth random path.
  tap,     ///< Up and down at one place, taps_per_s times a second.
};

struct StrokeOptions {
  Motion motion = Motion::stroke;
  std::uint64_t seed = 1;  ///< Of the random slide.
  double circle_m = 0.01;  ///< Radius.
  double taps_per_s = 4;
  double depth_m = 1e-3;  ///< Depth of the probe's lowest point below the surface.
  double speed_m_per_s = 0.1;
  double seconds = 2;        ///< Duration of the whole trajectory.
  double approach_m = 5e-3;  ///< Height of that point above the surface at the start; less where a wall is near.
  double press_s = 0.25;     ///< Time from there to full depth.
};

/// The hand of a run without a trajectory: approaches the base point of `material` that is closest to `near`, presses,
/// and moves over that material according to `motion`, reversed where the material ends. The path is the base surface
/// moved inwards by the depth less the probe's radius, in steps of 1 mm or a hundredth of the scene, whichever is
/// shorter. Deterministic. Cost: one closest-point query a step.
/// @throws InvalidInput when the surface has no triangle of the material or a number is not > 0.
Trajectory press_and_stroke(const ContactSurface& surface, std::uint32_t material, Vec3 near,
                            const StrokeOptions& options);

}  // namespace papilla
