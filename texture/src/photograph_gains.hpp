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

/// The relief whose slopes come closest, with free borders: ΔZ = div(slopes) by the cosine transform. Mean 0.
/// Frankot and Chellappa 1988.
Field integrate(const Slopes& slopes, int width, int height);

/// Divides every photograph by its light_field(), and scales it to the mean 1. What is left has a level
/// mean surface.
void flatten(Photographs& photographs);

/// flatten() that leaves of the quadrics what belongs to the relief, and scales to the means light.z.
/// A quadratic and a cubic relief change the quadrics c_k of all photographs in proportion to their lights,
/// c_k = v + R_k θ + g_k, v the vignette, which is the same in all, and g_k the light of each, which is not. θ is the
/// mean of its posterior with a variance continued from the spectrum of the finer relief, g_k normal with a variance
/// found with it; a near lamp, which looks like a dome, is part of g_k.
void even_out(Photographs& photographs, const std::vector<Vec3>& lights);

/// How well four or more photographs agree.
struct Agreement {
  double ambient = 0;   ///< Light from everywhere, relative to a lamp that faces the surface; to 0.3, in steps.
  double residual = 0;  ///< Robust deviation of a photograph from what the others say, relative to the albedo.
};

/// Light from everywhere, (0, 0, ambient), with which photographs agree best, and which is added to `lights`: with
/// w ⊥ the lights, Σ w_k I_k = 0 at every pixel. 0 for three photographs.
Agreement agreement(const Photographs& photographs, std::vector<Vec3>& lights);

}  // namespace papilla::texture_detail
