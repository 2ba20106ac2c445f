// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "papilla/core/trace.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// A smooth displacement u(x) of the plane: pixel x of a picture lies at x + u(x) of the straight one. A bicubic
/// B-spline: u(x) = Σ_ij c_ij β(x/spacing − i) β(y/spacing − j) with the first control point at (−spacing, −spacing).
struct Displacement {
  int columns = 0, rows = 0;  ///< Of control points.
  double spacing_px = 1;
  std::vector<Vec2> control_px;  ///< Row by row.

  Vec2 at(Vec2 p) const;  ///< Points beyond the control points take the value at the border.
};

/// A lattice that bends; see find_lattice_deformation().
struct LatticeDeformation {
  Displacement displacement;         ///< Without an affine part.
  std::array<Vec2, 2> vectors_px{};  ///< The mean cell: that of the picture after u.
  double rms_percent_of_cell = 0;    ///< Root mean square of |u| over the picture, in % of the root of the cell's area.
  double max_percent_of_cell = 0;    ///< Greatest |u|, likewise.
  double explained_before = 0;       ///< Share of the variance that the mean cell explains without u, and with it.
  double explained_after = 0;
  bool significant = false;  ///< u explains more than its free parameters would by chance.
  Trace trace;               ///< Share of the variance that is not explained, in the part reached so far.
};

/// Options of find_lattice_deformation(). Lengths are shares of the root of the cell's area.
struct DeformationOptions {
  double bend = 0.05;       ///< Expected second difference of u over one cell.
  int most_intervals = 20;  ///< Control points along a side, at most about.
};

/// Finds the smooth displacement under which a picture is most regular. With I the picture, normalised to local mean 0
/// and deviation 1, B the lattice and P the mean cell,
///   minimise  Σ_w ρ( |I(x) − P(B⁻¹(x + u(x)))|²_w ) + bending(u) / bend²
/// over windows w of about a cell, ρ Cauchy's loss. Every round averages P over the part reached, moves every window to
/// where its picture fits P best (one step of Lucas and Kanade), and fits u to these places by least squares with their
/// information matrices as weights (Ceres). The part reached grows from the cells that repeat best, so that neighbours
/// are followed across any number of periods. Afterwards the affine part of u is moved into the vectors.
///
/// Good input: cells of 5 pixels or more, at least three of them a side, neighbours of which differ by less than a
/// quarter of a cell. Perspective is followed as far as it is smooth; folds and dislocations are not.
/// Cost: about 0.2 s at 512² and cells of 30 pixels. Deterministic.
/// @param vectors_px  a lattice found from neighbouring cells, good to a tenth of a cell.
/// @throws InvalidInput when the picture is empty or not finite, the vectors span no cell of it or an option is out of
///         range.
/// Liu, Lin and Hays, Near-regular texture analysis and manipulation, 2004; Hays, Leordeanu, Efros and Liu, Discovering
/// texture regularity as a higher-order correspondence problem, 2006; Park, Brocklehurst, Collins and Liu, Deformed
/// lattice detection in real-world images, 2009; Lucas and Kanade, 1981.
LatticeDeformation find_lattice_deformation(const GreyImage& image, const std::array<Vec2, 2>& vectors_px,
                                            const DeformationOptions& options = {});

/// The picture straightened: value at y is that of the picture (bicubic) at the x for which x + u(x) = y. Places from
/// beyond the borders take the border's value. The same size. Cost: O(pixels).
GreyImage straightened(const GreyImage& image, const Displacement& displacement);

/// The x for which x + u(x) = y, by fixed-point iteration; exact to 1e-3 pixels where u changes by less than 0.6 a
/// pixel.
Vec2 bent_place(const Displacement& displacement, Vec2 y);

}  // namespace papilla
