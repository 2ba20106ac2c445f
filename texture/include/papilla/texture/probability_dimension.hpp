// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/texture/fractal.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Options of probability_dimension(); the default reproduces the published table (windows below
/// about 11 pixels break the method on rough surfaces).
struct ProbabilityOptions {
  int least_side = 11;  ///< Smallest cube side L in pixels, odd, at least 3.
  int most_side = 33;   ///< Largest cube side, odd, at most 33; every odd side between is used.
};

/// How many cubes hold how many points, for one cube side.
struct CubeHistogram {
  int side = 0;                      ///< L in pixels.
  std::vector<std::int64_t> counts;  ///< counts[m]: centres whose cube holds m points, m = 0…L².
};

/// Counts, for every cube side L, how many points m of the surface {(x, y, g)} lie in the cube of side
/// L centred on each pixel whose L × L window fits: m = #{|Δg| ≤ (L−1)/2}. g is stretched to 0…255
/// and rounded. Exact; independent of the number of threads.
/// Cost: about 20 operations a pixel and side whatever the side, from one table of running counts
/// over rows that all sides share, 2 MB of memory a thread.
/// @throws InvalidInput when the picture is smaller than two largest sides, empty or not finite, or an option is out of
/// range.
std::vector<CubeHistogram> cube_histograms(const GreyImage& image, const ProbabilityOptions& options = {});

/// Probability dimension (Voss): N(L) = Σ_m P(m, L) / m with P from cube_histograms(); D is the
/// negative slope of log N over log L. The interval is that of the regression (neighbouring sides are
/// correlated: it is too narrow).
/// On exact fractional Brownian surfaces of 256² D = 2.2, 2.5, 2.8 is read as about 2.18, 2.50, 2.78;
/// larger pictures are flatter at pixel scale after the stretch to 255 grey levels and are read too low.
/// @throws InvalidInput as cube_histograms().
/// Voss, Random fractals: characterization and measurement, 1986; Schulze 2005, definition 6.5.
FractalEstimate probability_dimension(const GreyImage& image, const ProbabilityOptions& options = {});

}  // namespace papilla
