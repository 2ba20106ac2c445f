// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chart_field.hpp"
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

/// Half-edges of a piece that make it genus 0 with a border when cut, along short paths of little weight: handles are
/// opened, border loops joined [Erickson, Whittlesey 2005], a sphere slit between two far points. Without `all_loops`,
/// holes stay that a flat sheet could have (their turning is -2π within k_hole_turning_deg), since they need no cut to
/// be flattened. Nothing when OpenMesh can't hold the piece.
struct Opening {
  bool possible = true;
  std::vector<Index> cuts;  ///< Piece half-edges, one per edge; empty: nothing to do.
};
Opening open_chart(const Piece& piece, const SeamWeights& weights, bool all_loops);

/// Cuts that relieve a chart's distortion, as piece half-edges, one per edge. Each starts where the scale of the map of
/// ChartField is farthest from the border's: a slit to the border along the path of least cost, where the surface
/// bulges, or a cut across, along the ridge of the scale. A cut is taken while it lowers the distortion by more than
/// `seam_cost` times its cost (SeamWeights) over the square root of the piece's area.
std::vector<Index> relieve(const Piece& piece, ChartField& field, const SeamWeights& weights, double seam_cost);

}  // namespace papilla::detail
