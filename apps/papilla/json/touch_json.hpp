// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "json/json.hpp"
#include "papilla/pipeline/material_differences.hpp"
#include "papilla/pipeline/texture_survey.hpp"

namespace papilla::app {

/// {speed_m_per_s, speeds_m_per_s[], weber[] {quantity, unit, fraction, noise, source}, receptors[] {name, senses,
/// low_hz, high_hz}, materials[] {name, stiffness, damping, static_friction, dynamic_friction, relief}, pairs[] {a, b,
/// stiffness, viscosity, friction, roughness, verdict, reason}}. A relief is null before it is made and where there is
/// none, else {frequencies_hz[], receptors[] {name, variance_share, times_threshold}, times_threshold,
/// most_times_threshold, roughness, finest_felt_mm, may_be_left_out, size[], needed_size[], bytes, needed_bytes}. A
/// difference is null where it is not known, "infinite" where only one of the two is 0.
Json touch_json(const TouchReport& report);

/// {speed_m_per_s, frequencies_hz[], receptors[] {name, variance_share}, unfelt_share, needed_size[]}.
Json touch_survey_json(const TouchSurvey& touch);

}  // namespace papilla::app
