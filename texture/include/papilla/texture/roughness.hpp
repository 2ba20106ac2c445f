// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "papilla/texture/fractal.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla {

/// Roughness parameters of a relief; see measure_roughness().
struct Roughness {
  double rms_mm = 0;  ///< Root mean square height about the mean.
  std::optional<FractalEstimate>
      fractal;         ///< By best_dimension(); absent below 32 samples a side and without a power law.
  std::string reason;  ///< Why there is a power law, or none; empty below 32 samples a side.
  double shortest_wavelength_mm = 0, longest_wavelength_mm = 0;  ///< What the samples can hold: 2 pitches to one side.
};

/// Options of measure_roughness().
struct RoughnessOptions {
  bool dimension = true;  ///< Fit the fractal dimension, which is nearly all of the cost.
};

/// The roughness that the haptic tag carries. Cost: O(samples). Deterministic.
/// @throws InvalidInput when the relief is empty, not finite or without pitch.
Roughness measure_roughness(const HeightMap& relief, const RoughnessOptions& options = {});

/// Root mean square height about the mean, in millimetres. @throws InvalidInput when the relief is empty or not finite.
double rms_height_mm(const HeightMap& relief);

}  // namespace papilla
