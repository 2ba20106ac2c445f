// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "papilla/core/progress.hpp"
#include "papilla/texture/height_grid.hpp"

namespace papilla {

/// Options of brownian_surface_exact().
struct BrownianSurfaceOptions {
  int size = 257;      ///< Samples a side, 2 to 2049.
  double hurst = 0.5;  ///< H in (0, 1); the dimension is 3 − H.
  std::uint64_t seed = 1;
  ProgressCallback progress = {};
};

/// Exact fractional Brownian surface: a Gaussian random field with
///   E[(X(s) − X(t))²] = |s − t|^(2H),  |s − t| in pixels,
/// for every pair of grid points, not periodic. Made by circulant embedding of an intrinsically equivalent
/// stationary covariance with compact support, plus a random plane that restores the variogram.
/// It is the ground truth of the estimators: power-law FFT synthesis lacks aliased power and midpoint
/// displacement creases.
/// Cost: two real FFTs of side 2√2·(size−1), or 4√2·(size−1) for H > 3/4 (257 MB at size 1025).
/// Deterministic for a seed.
/// @throws InvalidInput when an option is out of range; SolverFailure when the embedding is not positive definite.
/// Stein, Fast and exact simulation of fractional Brownian surfaces, J. Comp. Graph. Stat. 11(3), 2002.
HeightGrid brownian_surface_exact(const BrownianSurfaceOptions& options);

}  // namespace papilla
