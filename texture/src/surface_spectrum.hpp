// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "spectrum_cells.hpp"

namespace papilla::texture_detail {

/// How a self-affine surface became pixels. Transfer functions of a frequency k in cycles per pixel, before (physical)
/// or after (on the grid) the surface is sampled.
enum class PointSpread {
  optical,       ///< exp(−2π²σ²k²), then sampled.
  pixel,         ///< The same and the mean over the square of a pixel, sinc(kx) sinc(ky), then sampled.
  kernel,        ///< Sampled, then convolved with the sampled Gaussian kernel.
  filtered,      ///< Sampled, then multiplied by exp(−2π²σ²k²) in the frequency domain.
  band_limited,  ///< Nothing above the highest frequency of the grid, then exp(−2π²σ²k²).
};

/// Power spectrum of the sampled surface of amplitude 1 at the frequencies of cells,
///   S(f) = Σ_m |f + m|^(−2H−2) |transfer(f + m)|²,
/// the sum over all frequencies f + m that look alike on the grid, 25 one by one and the rest as an integral (relative
/// error below 1e-4), and the derivatives of its logarithm.
struct SurfaceSpectrum {
  std::vector<double> power, by_hurst, by_spread;  ///< S, ∂ln S/∂H, ∂ln S/∂(σ²); one value a cell.
};

class SurfaceSpectrumModel {
 public:
  explicit SurfaceSpectrumModel(std::span<const SpectrumCell> cells);

  /// @param spread_squared  σ² in pixels², ≥ 0. @param hurst  in (0, 1).
  void evaluate(PointSpread spread, double hurst, double spread_squared, SurfaceSpectrum& result) const;
  std::size_t size() const { return fx_.size(); }

 private:
  static constexpr int k_reach = 2, k_aliases = (2 * k_reach + 1) * (2 * k_reach + 1);
  struct Alias {
    double log_squared, squared, pixel;  ///< ln k², 4π²k², sinc²(kx) sinc²(ky).
  };
  void add_aliases(bool pixel, double hurst, double spread_squared, SurfaceSpectrum& result) const;
  void interpolate(double hurst, SurfaceSpectrum& result) const;

  static constexpr std::size_t k_nodes = 10;
  std::vector<double> fx_, fy_;
  std::vector<std::array<Alias, k_aliases>> aliases_;  ///< The frequency itself comes first.
  std::vector<std::array<double, k_nodes>> sharp_;  ///< ln(H · all other aliases), sharp, at Chebyshev's nodes of H.
};

}  // namespace papilla::texture_detail
