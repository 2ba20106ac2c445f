// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/pipeline/fit_material.hpp"
#include "papilla/pipeline/pictures/plot.hpp"

namespace papilla {

/// A fit to look at: measured and fitted force over time, normal and along the way; and friction over the speed of
/// slip, as measured along a fitted load and as the curve that was found. About 4000 samples of each are drawn.
std::vector<Plot> fit_plots(const MaterialFit& fit);

}  // namespace papilla
