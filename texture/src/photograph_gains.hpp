// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla::texture_detail {

using Field = std::vector<double>;

/// Photographs of one place under several lights, as linear brightness in common units.
struct Photographs {
  int width = 0, height = 0;
  std::vector<Field> fields;  ///< One a photograph, row by row.
};

/// Slopes ∂Z/∂x and ∂Z/∂y, row by row.
struct Slopes {
  Field across, down;
};

/// The relief whose slopes come closest, with free borders: ΔZ = div(slopes) by the cosine transform. Waves near the
/// pixel are raised by what half a pixel of blur takes from them, by 1.4 at most. Mean 0.
/// Frankot and Chellappa 1988.
Field integrate(const Slopes& slopes, int width, int height);

/// Divides every photograph by its light_field(), and scales it to the mean 1. What is left has a level
/// mean surface.
void flatten(Photographs& photographs);

/// Divides every photograph by its gain, a polynomial of third degree of log brightness, and adds the light from
/// everywhere, (0, 0, ambient), to the lights. What is the same in all photographs, as a vignette, is left in them: it
/// is albedo. The gains are those of the greatest posterior of
/// - what photographs disagree by, with four or more: Σ_k w_k e^(−g_k) I_k = 0 at every pixel for w ⊥ the lights, which
///   fixes the gains wherever the relief has slopes of all directions; noise is the same in all pixels and photographs,
///   counts less where neighbours have it in common, and outliers count nothing;
/// - the relief's waves of less than 2¼ periods along the longer side, whose variance is that to which the spectrum of
///   the shorter ones continues, and its mean slope, about 0;
/// - gains of a usual size.
/// @return ambient, relative to a lamp that faces the surface; 0 for three photographs.
double even_out(Photographs& photographs, std::vector<Vec3>& lights);

/// Robust deviation of a photograph from what the others say, relative to the albedo; 0 for three photographs.
double disagreement(const Photographs& photographs, const std::vector<Vec3>& lights);

}  // namespace papilla::texture_detail
