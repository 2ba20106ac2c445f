// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/device.hpp"
#include "papilla/io/haptic_scene.hpp"
#include "papilla/pipeline/bake_scene.hpp"

namespace papilla::testing {

/// The rules of data/cockpit.materials.json, with the pictures that ./run demo makes for them, in `folder`.
Materials demo_rules(const std::filesystem::path& data, const std::filesystem::path& folder);

/// A rule for each built-in recipe of a material, new or aged; 40 mm a repeat.
Materials recipe_rules();

/// A plate of 120 mm in the plane z = 0, baked with one of the rules, as it is felt by the probe of a device.
struct FeltPlate {
  BakeResult baked;
  HapticScene haptic;
  ContactSurface surface;
};
FeltPlate felt_plate(const MaterialRule& rule, const DeviceCaps& device, const HapticSceneOptions& options = {});

/// A hand that presses in 0.25 s and then moves straight on.
struct Stroke {
  double depth_m = 5e-4;  ///< Of the probe's lowest point below the mesh.
  double speed_m_per_s = 0.02;
  double way_m = 0.06;
  double angle = 0;  ///< Of the way, from x.
  Vec3 shift = {};   ///< Of the whole path.
  int substeps = 1;  ///< Ticks a millisecond, for the limit of many.
};

/// Forces of the whole path from positions to a device, a millisecond apart, with the work of the ticks before.
struct StrokeForces {
  std::vector<Vec3> force_n;
  std::vector<double> sweeps, tick_s;
  double lag_m = 0;           ///< Largest distance of the proxy from the probe along the plate.
  double lateral_ratio = 0;   ///< Largest lateral over normal force while it moves.
  double largest_step_n = 0;  ///< Largest change of the force in a tick, from the third tick of the contact on.
  long lost = 0;
};
/// @param clock  seconds, which time the ticks; none: they are not timed.
StrokeForces stroke_forces(const ContactSurface& surface, const DeviceCaps& device, const Stroke& stroke,
                           double (*clock)() = nullptr);

/// Root mean square of the difference over that of `a`.
double relative_difference(const StrokeForces& a, const StrokeForces& b);

/// The worst over `angles` of the stroke's first ways in a fan of a right angle, each compared with itself moved by a
/// micrometre along x, y and z.
struct Steadiness {
  double worst = 0, mean = 0;
  StrokeForces extremes;  ///< Without the forces.
};
Steadiness steadiness(const ContactSurface& surface, const DeviceCaps& device, Stroke stroke, int angles);

}  // namespace papilla::testing
