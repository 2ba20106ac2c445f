// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "papilla/pipeline/fit_material.hpp"

namespace papilla::app {

/// A line a number with its interval and unit, then what is not identified and why, then how well the fit explains the
/// forces.
std::string fit_text(const MaterialFit& fit);

/// "stiffness 902 [897, 907] N/m, …", of all that was identified.
std::string fit_intervals(const MaterialFit& fit);

}  // namespace papilla::app
