// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/texture/height_map.hpp"
#include "papilla/texture/part_roughness.hpp"

namespace papilla {

/// The waves of a relief in a band of a third of an octave.
struct WaveBand {
  double shortest_mm = 0, longest_mm = 0;  ///< In [shortest, longest); their geometric mean stands for the band.
  double variance_mm2 = 0;                 ///< Of these waves together; a single wave of amplitude a has a²/2.

  double wave_mm() const noexcept;
};

/// How a relief's variance about its mean spreads over wavelengths, whatever their direction: Fourier waves of a relief
/// that repeats, cosine waves (borders reflected) of one that does not. Bands are thirds of octaves around 1 mm,
/// without gaps from the shortest wave to the longest; the sum of their variances is the variance of the relief.
/// Cost: one transform of the samples, of four times as many of a relief that does not repeat. Deterministic.
/// @returns ascending; empty for a level relief.
/// @throws InvalidInput when the relief is empty, not finite or without pitch.
std::vector<WaveBand> wave_bands(const HeightMap& relief, bool repeats);

/// Adds roughness that is laid over the relief: its rms² spread over its wavelengths by the power law, whose variance
/// in a band of equal ratio grows as λ^2H.
void add_roughness(std::vector<WaveBand>& bands, const RoughnessModel& roughness);

}  // namespace papilla
