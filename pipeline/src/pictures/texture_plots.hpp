// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "papilla/pipeline/pictures/plot.hpp"
#include "papilla/pipeline/texture_survey.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla {

/// Measure over scale of every reading that has an estimate, both logarithmic and each divided by its first value, so
/// that slopes can be compared.
Plot log_log_plot(std::span<const FractalReading> readings);

/// Hurst exponent by direction as polar plot, with the fitted ellipse; angles as in the picture, clockwise from right.
Plot hurst_plot(const FshotSignature& signature);

/// Height over the middle row and the middle column, in millimetres.
Plot section_plot(const HeightMap& map);

}  // namespace papilla
