// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/image.hpp"
#include "papilla/texture/lattice.hpp"

namespace papilla::texture_detail {

/// How often a picture without a lattice, but otherwise with this one's spectrum, reaches a significance as high as
/// that of `lattice`, found with `options` in the feature matrix of the picture. Surrogates are Gaussian noise with the
/// picture's power spectrum, in which the waves at the nodes of the lattice's reciprocal lattice are replaced by those
/// around them: a ring (a size of grain) or a wedge (a direction) stays, a lattice doesn't. They are treated as the
/// picture is. Significances of noise are taken as exponentially distributed with the surrogates' mean, at least `0.2 /
/// √cells` of the scatter of a correlation over so many cells:
///   p = exp(−significance / mean).
/// Ends as soon as the answer at `rate` is clear; at most 39 surrogates, of at most 256 pixels a side, scaled so that
/// eight cells fit. Cost: 0.03 s in clear cases, 0.4 s at most. Deterministic.
double false_alarm_probability(const GreyImage& image, const Lattice& lattice, const LatticeOptions& options,
                               double rate);

}  // namespace papilla::texture_detail
