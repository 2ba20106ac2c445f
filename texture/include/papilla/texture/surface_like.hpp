// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/texture/fshot_dimension.hpp"
#include "papilla/texture/height_grid.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Options of surface_like().
struct SurfaceLikeOptions {
  int size = 256;  ///< Samples a side, 64 to 4096.
  int rounds = 6;  ///< Most corrections of the two Hurst exponents.
  std::uint64_t seed = 1;
  ProgressCallback progress = {};
};

/// What surface_like() returns.
struct SurfaceLike {
  HeightGrid surface;                  ///< Tiles; rms as the picture's grey values.
  FshotSignature target, achieved;     ///< Of the picture and of the surface.
  double hurst = 0, hurst_across = 0;  ///< Given to spectral_surface(): along the roughest direction and across it.
  Trace trace;                         ///< Distance of (Sta, Sta/Str) from the target after each round.
};

/// A fractal surface with the fractal signature of a picture: H along and across the roughest direction of
/// fshot_dimension() and the rms of the grey values are taken from the picture, and the two exponents of
/// spectral_surface() are corrected by what the signature of the result is off, round by round, the best round is kept.
/// The signature is all that is alike: a picture with a lattice gives a surface without one.
/// Exponents are kept within [0.02, 0.98]: what lies beyond can't be met, see `achieved`.
/// Cost: `rounds` times a synthesis and a signature, about 0.2 s at 256². Deterministic for a seed.
/// @throws InvalidInput when the picture is smaller than 64 pixels a side, empty or not finite, or an option is out of
/// range.
/// Cho et al. 2017, section 4 (their next step).
SurfaceLike surface_like(const GreyImage& image, const SurfaceLikeOptions& options = {});

}  // namespace papilla
