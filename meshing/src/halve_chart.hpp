// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "piece.hpp"
#include "seam_weights.hpp"

namespace papilla::detail {

/// Cuts, as piece half-edges, that part a piece of two triangles or more: the path of least cost across it, from border
/// to border half way between its two farthest triangles; holes on the way cost nothing. Where there is no such path,
/// the edges between the triangles nearer to one and to the other of the two.
std::vector<Index> cut_in_halves(const Piece& piece, const SeamWeights& weights);

/// The same between two given triangles on the border, which come into different parts.
/// @param a,b different.
std::vector<Index> cut_apart(const Piece& piece, const SeamWeights& weights, Index a, Index b);

}  // namespace papilla::detail
