// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla {

/// One sample of a recorded stroke, in SI units and one frame.
struct StrokeSample {
  double t_s = 0;
  Vec3 probe_m;                          ///< Centre of what touches.
  Vec3 force_n;                          ///< On the hand: it points out of the surface.
  std::optional<Vec3> proxy_m;           ///< Place of the probe on the surface, where the recording knows it.
  std::optional<Vec3> velocity_m_per_s;  ///< Of the probe, where it was measured.
};

/// Reads a recording: CSV with a heading, whose columns may be in any order and others beside them. Needed are t,
/// force_x, force_y, force_z, and probe_x, probe_y, probe_z (or x, y, z); proxy_x … and velocity_x … are read where
/// they are. So `papilla-player --record` writes it (record_csv()). Seconds, metres, newtons; empty lines and lines
/// that start with # are skipped, the decimal separator is a point in every locale.
/// @param name of the text in messages.
/// @returns at least two samples; with proxy and velocity in all of them or in none.
/// @throws InvalidInput naming name:line and the reason: a column that is missing, no number, a number that is not
/// finite or a place farther than 1000 km, time that does not increase, fewer than two samples.
std::vector<StrokeSample> parse_stroke_recording(std::string_view csv, const std::string& name);

}  // namespace papilla
