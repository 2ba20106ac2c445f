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

/// Warns of a scene in assumed millimetres that is smaller or larger than what interiors are made of, by the last word
/// of its file's name where that says what it is, and names units in which it would not be.
void hint_at_unit(Scene& scene, const std::string& file_name);

/// Adds a root node of the part's name for every part, then the parts' ids. Parts without name get `fallback_name`.
void add_part_nodes(Scene& scene, const std::string& fallback_name);

}  // namespace papilla
