// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include "option_checks.hpp"
#include "papilla/pipeline/felt_waves.hpp"

namespace papilla::app {

/// --stroke-speed: of the hand that the report on touch is about.
inline void add_stroke_speed(CLI::App& verb, TouchOptions& options) {
  verb.add_option("--stroke-speed", options.speed_m_per_s,
                  "Of the hand in the report on touch; what may be left out is so from a fifth to twice of it")
      ->type_name("M/S")
      ->check(in_range(1e-3, 10))
      ->capture_default_str();
}

}  // namespace papilla::app
