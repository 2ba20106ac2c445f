// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/trajectory.hpp"

namespace papilla {

/// What a synthetic hand does once it presses.
enum class Motion {
  stroke,  ///< Straight along the surface, back where it ends.
  circle,  ///< Around a circle of circle_m, on the surface.
  slide,   ///< A smooth random way.
  tap,     ///< Up and down at taps_per_s, on one place.
};

struct StrokeOptions {
  Motion motion = Motion::stroke;
  std::uint64_t seed = 1;  ///< Of the random slide.
  double circle_m = 0.01;  ///< Radius.
  double taps_per_s = 4;
  double depth_m = 1e-3;  ///< How far the hand goes below the surface.
  double speed_m_per_s = 0.1;
  double seconds = 2;        ///< Length of the whole trajectory.
  double approach_m = 5e-3;  ///< Height above the surface at which it starts.
  double press_s = 0.25;     ///< Time from there to full depth.
};

/// The hand of a run without a trajectory: comes down on the base point of `material` that is nearest to `near`,
/// presses, and moves over that material as `motion` says, back where the material ends. The path is the
/// base surface moved inwards by the depth, in steps of 1 mm or a hundredth of the scene, whichever is shorter.
/// Deterministic. Cost: one closest-point query a step.
/// @throws InvalidInput when the surface has no triangle of the material or a number is not > 0.
Trajectory press_and_stroke(const ContactSurface& surface, std::uint32_t material, Vec3 near,
                            const StrokeOptions& options);

}  // namespace papilla
