// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "papilla/haptic/haptic_loop.hpp"
#include "papilla/haptic/stability.hpp"
#include "papilla/io/haptic_scene.hpp"
#include "vibration_output.hpp"

namespace papilla::player {

/// The result of a run.
struct RunReport {
  std::string file, device;
  double rate_hz = 0, stiffness_limit = 0, load_seconds = 0, probe_radius_m = 0;
  std::size_t triangles = 0, contact_bytes = 0;
  int maps_loaded = 0, maps_missing = 0, maps_coarsened = 0, roughness_overlays = 0;
  int channels_loaded = 0, channels_missing = 0;
  std::size_t triangles_out_of_reach = 0;
  std::vector<StabilityClamp> clamps;
  std::vector<std::string> material_names;
  TagSurvival tags;
  std::vector<MaterialWarning> warnings;
  LoopResult loop;
  std::optional<VibrationReport> vibration;
  std::optional<double> registration_residual_mm;  ///< Of a real part, by three points.
};

nlohmann::ordered_json to_json(const RunReport& report);

/// The result as text.
std::string summary(const RunReport& report);

}  // namespace papilla::player
