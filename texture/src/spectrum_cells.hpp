// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "papilla/texture/image.hpp"

namespace papilla::texture_detail {

/// Neighbouring frequencies of a picture, in cycles per pixel, and those mirrored at the x axis: waves along
/// (fx, fy) and along (fx, −fy).
struct SpectrumCell {
  double fx = 0, fy = 0;            ///< Mean, both in [0, 0.5].
  std::array<double, 2> power{};    ///< Mean density of the variance of the grey values, per unit of fx · fy.
  std::array<double, 2> largest{};  ///< The largest of the single frequencies.
  std::array<double, 2> count{};    ///< Independent frequencies: `power` scatters by 1/√count of itself.

  double frequency_squared() const { return fx * fx + fy * fy; }
};

/// The periodogram of a picture by cells whose sides are at most an eighth of their frequency and 1/64. The picture is
/// sharpened by the discrete Laplacian, which is divided out of the spectrum again, and fades out at its borders (Tukey
/// window), so that neither tilt and bend nor borders leak into high frequencies. Frequencies whose waves are longer
/// than half of the shorter side are left out. Cost: one transform. Deterministic.
/// @pre at least 16 pixels a side, values finite.
std::vector<SpectrumCell> spectrum_cells(const GreyImage& image);

}  // namespace papilla::texture_detail
