// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/trajectory.hpp"
#include "papilla/pipeline/stroke_recording.hpp"

namespace papilla::testing {

/// What a hand does on a plate of 0.1 m in the plane z = 0; every part takes two seconds, one after the other.
struct HandPlan {
  bool presses = true;    ///< In and out, five times a second, at one place.
  bool rests = true;      ///< In contact.
  bool crawls = true;     ///< To and fro at up to 12 mm/s.
  bool hurries = true;    ///< To and fro at up to 210 mm/s.
  bool steadily = false;  ///< To and fro at 80 mm/s instead of crawling and hurrying, without pressing.
  double depth_m = 1.5e-3;
};

/// Without any part the hand stays 5 mm above the plate.
Trajectory hand_of(const HandPlan& plan);

/// A plate of one material, flat.
ContactSurface flat_plate(const ContactMaterial& material);

/// The player's loop on a simulated device without friction and quantisation that every stiffness up to 9000 N/m is
/// stable on; its recording written as CSV and read again.
std::vector<StrokeSample> record_stroke(const ContactSurface& surface, const Trajectory& hand, double max_force_n = 20);

/// Normal noise on every component of force, a share of the largest force.
void add_force_noise(std::vector<StrokeSample>& stroke, double share, std::uint64_t seed);

/// As a force sensor and a tracker would record it: without proxies, in another frame.
std::vector<StrokeSample> seen_from_outside(std::vector<StrokeSample> stroke);

}  // namespace papilla::testing
