// SPDX-License-Identifier: MIT
#pragma once

#include "shorten_seams.hpp"

namespace papilla::param_detail {

/// Moves stretches of seam sideways, between the same two ends, to where they cost less or leave less energy.
///
/// Both sides of a seam are free borders of a map of least energy E = Σ A (e - 4): to first order E changes by what the
/// seam sweeps over, from one side to the other, at the densities e - 4 of both,
///     dE = ∫ (e_right - e_left) v ds,   v how far it moves to the left
/// (the derivative by the domain [Hadamard 1908]; the force on a defect [Eshelby 1951]). So triangles beside a stretch
/// are given to its left or right side so that
///     p Σ c_h + Σ A (e - 4),   over the seams between the sides, and over the triangles,
/// is least, p = 4 E / Σ c: what a seam has to be worth where D - 4 falls with the fourth power of their length. What
/// changes sides counts with the density beside the nearest edge of the stretch on its new side. It is a least cut; up
/// to six triangles deep on either side; none of those that touch another stretch, or that lie beside one more nearly.
/// All stretches that gain are tried together, then one by one, as take_exchanges() says.
/// @param state keeps the bound. @param map_fully measures all that it maps, whatever it comes to. @return a state that
/// keeps it too and whose seams cost no more. Cost: a map for each trial, four that fail end it; O(n) and a cut for
/// each stretch besides.
SeamState shift_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                      const MapSeams& map_fully, const Deadline& deadline);

}  // namespace papilla::param_detail
