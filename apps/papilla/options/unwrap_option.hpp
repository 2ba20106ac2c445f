// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "papilla/pipeline/unwrap_scene.hpp"

namespace papilla::app {

/// --effort fast|normal|best.
void add_effort(CLI::App& verb, UnwrapEffort& effort);

/// The options of `unwrap` that say how: method, charts, grain, layout and those of single methods.
struct UnwrapOption {
  UnwrapOptions unwrap;
  std::string solver, direction, eye;  ///< Empty: the method's own.
  std::string max_distortion;          ///< Empty: none.
  std::vector<std::string> grains;
  int texture_px = 0;  ///< 0: no second set of uv.
  double gutter_px = 4;
  std::vector<std::string> density, pins, iso_lines;
  std::vector<double> tile{0, 0};
  /// Options of some methods only, by the names that foreign_option() has for them.
  std::vector<std::pair<std::string, const CLI::Option*>> of_methods;

  void add_to(CLI::App& verb);
  /// @throws UsageError for options that contradict each other, and for texts that are none of what they should be.
  UnwrapOptions options() const;
};

/// "X,Y,Z=U,V", and "@PART" behind it, as a pin. @throws UsageError quoting the text when it is nothing such.
PlacedPin parse_pin(const std::string& text);

/// "u:X,Y,Z;X,Y,Z...", "v=VALUE:X,Y,Z;...", and "@PART" behind it, as a line of equal u or v.
/// @throws UsageError quoting the text when it is nothing such.
PlacedIsoLine parse_iso_line(const std::string& text);

/// "up", "longest", "X,Y,Z" or "edge:X,Y,Z", and "@PART" behind it, as the direction of the grain.
/// @throws UsageError quoting the text when it is nothing such.
PlacedGrain parse_grain(const std::string& text);

/// Pins and lines that are held must name a part of the scene when it has several; parts that are named must exist.
/// @throws UsageError naming the option.
void check_held_parts(const MethodOptions& method, const std::string& file, const Scene& scene);

}  // namespace papilla::app
