// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "papilla/param/levy.hpp"

namespace papilla {

/// What keeps charts from LevyCoupling::conformal, which needs a border that is free from the start, the direct solver
/// and no iso line, as a clause; empty where it can be kept.
/// @param has_iso_lines of the chart, or of any chart before they are known.
std::string conformal_obstacle(const LevyOptions& options, bool has_iso_lines);

}  // namespace papilla
