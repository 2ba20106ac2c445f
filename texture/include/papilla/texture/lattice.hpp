// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/feature_matrix.hpp"

namespace papilla {

/// How minima become a lattice; see find_lattice().
enum class LatticeMethod { best, projection };

/// Options of find_lattice(). Thresholds are shares of the picture's own variance.
struct LatticeOptions {
  LatticeMethod method = LatticeMethod::best;
  double least_significance = 0.3;  ///< find_lattice(): below this there is no lattice. It sees only the matrix.
  double false_alarm_rate = 0.01;   ///< analyze_symmetry(): most noises with the picture's spectrum that may repeat as
                                    ///< well, in (0, 1]; replaces least_significance. 1 takes the best lattice.
  double node_tolerance = 0.82;     ///< Correlation, relative to the best, from which a shift counts as a repetition.
  double index_tolerance = 0.95;  ///< Of two lattices, one within the other, the finer one is taken from this share on.
  int most_candidates = 24;       ///< Shortest good minima that are paired to candidate bases.
  double reach_cells = 0;  ///< Only nodes within so many cells count, for lattices that bend; 0: all of the matrix.
};

/// The translations under which a picture repeats; see find_lattice().
struct Lattice {
  bool found = false;
  /// Gauss-reduced primitive basis, x right, y down, in pixels: |a·b| ≤ ½ min(|a|², |b|²), a is the
  /// one nearer to the horizontal and points right, b points down.
  /// Zero when not found.
  std::array<Vec2, 2> vectors_px{};
  /// Mean over all lattice nodes of how far the correlation rises above its mean over one cell around the
  /// node, divided by the share of variance that is not pixel noise: about 1 for an exact repetition under any noise,
  /// about 0 where nothing repeats.
  double significance = 0;
  double stripes =
      0;          ///< Correlation of a picture that repeats in one direction only with itself at that period, else 0.
  int nodes = 0;  ///< Nodes of the half plane the vectors were fitted to.
  std::vector<Vec2>
      minima;          ///< Local minima of the feature matrix (half plane), sub-pixel, deepest first, at most 500.
  std::string reason;  ///< One sentence: why there is no lattice, or what it rests on.
};

/// Finds the lattice of a texture from its Statistical Feature Matrix.
/// The matrix is smoothed by one pixel and turned into correlation, its minima are located to sub-pixel accuracy,
/// pairs of the shortest deep ones are tried as bases, the smallest cell among those whose nodes all repeat
/// is kept, refined by least squares over all its multiples, and checked against the lattices that are 2, 3 and 5 times
/// finer or coarser. Needs no manual threshold. Stripes (a repetition in one direction only) are no lattice.
/// projection is the source's method: the two directions along which the deep minima line up best, and the most
/// frequent distances along them, without a fit; vectors to about a pixel, and wrong more often than `best` (the
/// benchmark counts both). Depth cut and test of significance are those of `best`.
/// Finds cells from about 4 pixels to just under half of the picture; noise with the variance of the signal costs
/// about 0.02 pixels of accuracy. Perspective and bent lattices are not followed.
/// Cost: O(matrix) and a few milliseconds at 256². Deterministic.
/// @throws InvalidInput when an option is not within (0, 1], fewer than 2 candidates are asked for, or the matrix is
/// not finite. Schulze 2005, section 7.2, with a fit in place of its projection method.
Lattice find_lattice(const FeatureMatrix& matrix, const LatticeOptions& options = {});

}  // namespace papilla
