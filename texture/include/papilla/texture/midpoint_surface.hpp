// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/texture/height_grid.hpp"

namespace papilla {

/// How midpoints are displaced.
enum class MidpointRule {
  corrected,  ///< Variances that follow from the variogram; see midpoint_surface().
  cho         ///< Three steps an iteration, displacements ±2^(−nH) with random sign.
};

/// Options of midpoint_surface().
struct MidpointOptions {
  int levels = 8;         ///< Halvings of the side, 1 to 13.
  double hurst = 0.5;     ///< H in (0, 1); the dimension is about 3 − H.
  bool periodic = false;  ///< Tiles: 2^levels samples a side instead of 2^levels + 1.
  MidpointRule rule = MidpointRule::corrected;
  std::uint64_t seed = 1;
  ProgressCallback progress = {};
};

/// Fractal surface by midpoint displacement, in units in which points one side apart differ by variance 1.
///
/// corrected: the four corners are drawn from the joint normal distribution with E[(X(s) − X(t))²] = |s − t|^(2H) (so
/// that X(1,1) − X(0,0) has variance 2^H). Then, by half stages: the centre of every square of side s is the mean of
/// its corners plus a normal displacement of variance s^(2H) (2^(−H) − ¼ − 2^(H−3)); the middle of every edge is the
/// mean of its four neighbours at distance s/2, whose square is turned by 45° and smaller by √2: the same variance
/// times 2^(−H). Border points of a surface that does not tile have three neighbours, and variance (s/2)^(2H) (1 − (4^H
/// + 2·2^H)/9). All follow from E[(ΔX)²] = r^(2H). The source's index rule leaves out edge midpoints, and scales like a
/// Brownian sheet where its indices differ.
///
/// cho: corners normal with variance 1; iteration n = 1…levels displaces by ±2^(−nH): centre = mean of 4 corners ± δ,
/// edge middle = mean of its 2 ends and the adjoining centres' mean ± δ, centre again = mean of 4 edge middles ± δ. The
/// paper prints δ like a variance; it acts as an amplitude.
///
/// Midpoint surfaces are creased along the coarse grid: their dimension at pixel scale is pulled towards 2.5 to 2.6.
/// brownian_surface_exact() is the ground truth.
/// Cost: O(samples). Deterministic for a seed.
/// @throws InvalidInput when an option is out of range.
/// Schulze 2005, section 6.3, corrected; Saupe in The Science of Fractal Images, 1988; Cho et al. 2017.
HeightGrid midpoint_surface(const MidpointOptions& options);

/// Options of brownian_graph().
struct BrownianGraphOptions {
  int levels = 10;     ///< Halvings, 1 to 24.
  double hurst = 0.5;  ///< H in (0, 1); the dimension of the graph is 2 − H.
  std::uint64_t seed = 1;
};

/// Fractional Brownian graph over [0, 1] by midpoint displacement: 2^levels + 1 values, X(0) = 0, X(1) normal with
/// variance 1, and in stage j every midpoint is the mean of its ends plus a normal displacement of variance
/// 2^(−2jH) (1 − 2^(2H−2)) — which is exact for H = ½ and, midpoint given both ends, for every H.
/// The source prints 2^(−jH), which is a standard deviation.
/// Cost: O(samples). Deterministic for a seed.
/// @throws InvalidInput when an option is out of range.
/// Schulze 2005, section 6.3, corrected; Mandelbrot and Van Ness, 1968.
std::vector<double> brownian_graph(const BrownianGraphOptions& options);

}  // namespace papilla
