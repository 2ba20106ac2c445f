// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/meshing/visibility.hpp"

namespace papilla::app {

/// Volumes given on the command line, in millimetres in the scene's frame; several are taken together:
/// "X,Y,Z,R" is a sphere, "X,Y,Z,X,Y,Z" the box between two corners, anything else names a JSON file (or is JSON
/// itself) with {"centre": [X,Y,Z], "radius": R}, {"min": [X,Y,Z], "max": [X,Y,Z]}, or an array of these.
/// @throws UsageError naming the option when the numbers make no volume; IoError, InvalidInput naming file and JSON
///         pointer.
std::vector<Volume> parse_volumes(const std::string& option, const std::string& text);

}  // namespace papilla::app
