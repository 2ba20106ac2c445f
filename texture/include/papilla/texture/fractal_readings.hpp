// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "papilla/core/progress.hpp"
#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/fractal.hpp"
#include "papilla/texture/fshot_dimension.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// The fractal dimension of a picture by every method; those that need a larger picture are empty.
struct FractalReadings {
  std::optional<FractalEstimate> box, information, correlation, probability;
  std::optional<FshotSignature> fshot;
  std::optional<BestDimension> best;
};

/// Least shorter side in pixels of what a method reads.
inline constexpr int k_least_fractal_side = 32, k_least_probability_side = 66;

/// All methods on one picture. Cost: the sum of theirs, about 0.4 µs a pixel. Deterministic.
/// @throws InvalidInput when the picture is empty or not finite.
FractalReadings read_fractal_dimensions(const GreyImage& image, const ProgressCallback& progress = {});

/// The readings of a picture too large for memory from those of its pieces: the mean over the pieces of every number,
/// curves as geometric means at the scales all pieces have, for fshot the ellipse through the mean Hurst exponents. The
/// 95 % intervals are those of the mean: ± t · deviation / √pieces, so that they show how far the pieces differ; with
/// one piece they are its own. Every method keeps the scales it was made for; the box family and `probability` depend
/// on the size of what they read, which is that of a piece. The quantization step is the smallest of the pieces.
/// `best` has a power law where at least half of the pieces have one and their ranges of scales overlap: its numbers
/// are the means over those pieces, its range of scales what they have in common. Otherwise the reason is that of most.
FractalReadings mean_readings(std::span<const FractalReadings> pieces);

}  // namespace papilla
