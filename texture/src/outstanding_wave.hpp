// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/image.hpp"

namespace papilla::texture_detail {

/// How likely the highest wave of a picture's spectrum is as high in a noise whose spectrum depends on the wave number
/// alone: with r the largest power of a wave (Hann window) over the mean at its wave number, which the medians of rings
/// of at least 48 waves give, and n the number of waves,
///   p = 1 − exp(−n e^(−r)),
/// the distribution of the largest of n exponential variables (the window ties neighbours together, so that p is a
/// little high). A picture that repeats has waves that no noise has; one
/// whose spectrum depends on the direction counts as outstanding, too. Spectra that fall more steeply than
/// those of surfaces with H = ½ may count as outstanding: the medians of wide rings are behind them. 1 for a flat or
/// tiny picture. Cost: a Fourier transform and a sort of its waves.
double chance_of_highest_wave(const GreyImage& image);

}  // namespace papilla::texture_detail
