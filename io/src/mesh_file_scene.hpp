// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "papilla/io/read_options.hpp"

namespace papilla {

/// An empty scene of a format that states neither unit nor axes.
/// @throws InvalidInput when `options.millimetres_per_unit` is not in (0, 1e9].
Scene unitless_scene(std::string format, const ReadOptions& options, UpAxis convention);

/// The linear colour of sRGB channels, cut to [0, 1].
Color color_from_srgb(double r, double g, double b, double alpha = 1);

/// Warns of a scene in millimetres so small that it is likely to be in metres or inches.
void warn_of_doubtful_unit(Scene& scene);

/// Adds a root node of the part's name for every part, then the parts' ids. Parts without name get `fallback_name`.
void add_part_nodes(Scene& scene, const std::string& fallback_name);

}  // namespace papilla
