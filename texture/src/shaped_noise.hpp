// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "papilla/core/progress.hpp"

namespace papilla::texture_detail {

/// Periodic Gaussian noise of rms 1 whose wave of u, v periods over the picture has the amplitude gain(u / width,
/// v / height) [cycles per pixel]; row by row. All 0 when no gain is above 0. Two Fourier transforms; deterministic for
/// a seed.
std::vector<double> shaped_noise(int width, int height, std::uint64_t seed,
                                 const std::function<double(double, double)>& gain,
                                 const ProgressCallback& progress = {});

/// Multiplies every wave of the field by gain(cycles per pixel along x, along y) ≥ 0: Fourier waves when periodic,
/// cosine waves (mirrored borders) otherwise.
void filter(std::vector<double>& field, int width, int height, bool periodic,
            const std::function<double(double, double)>& gain);

}  // namespace papilla::texture_detail
