// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/sample_rows.hpp"

namespace papilla {

/// Options of the shape-from-shading methods. The picture is taken as I = albedo · max(0, n·light) with
///   n·light = R(p, q) = (−s_x p − s_y q + s_z) / √(1 + p² + q²),  p = ∂Z/∂x, q = ∂Z/∂y,
/// x right, y down (as pixels are stored), z towards the viewer, s = light with length 1.
/// Pictures of any size: those longer than `largest_piece_px` are cut into pieces, at most four of which are solved at
/// a time. Memory is 8 bytes a pixel for the result (none with HeightWriter), the rows in work, which are 4.5 bytes
/// (tsai-shah: 8) a column and pixel of `largest_piece_px`, and a constant for the pieces in work; time grows with the
/// pixels. tsai-shah: pieces of the whole `largest_piece_px`, and as many pixels to their left and above as there are
/// steps, all that influence them; the result is that of the whole picture to the last bit, up to `largest_piece_px`
/// steps. variational and pentland: waves longer than a few pixels of the picture at half of `largest_piece_px` a side
/// come from that, the others from pieces with free borders that overlap by 128 pixels (a quarter of
/// `largest_piece_px`, if that is less) and are mixed by linear ramps, across the borders of periodic pictures too. How
/// much that differs from the whole is measured in the tests and the report of the benchmark.
struct ShadingOptions {
  Vec3 light{-0.5, -0.5, 0.7071};  ///< Direction to the light, any length, z > 0.
  double albedo = 1;               ///< Grey value of a surface that faces the light, positive.
  bool periodic = false;           ///< The picture tiles: so does the height. Otherwise the borders are free.
  int iterations = 150;            ///< At most this many steps, 1 to 100000.
  double relative_tolerance =
      1e-4;                  ///< variational: stop when five steps together lower the energy by less than this share.
  double smoothness = 0.05;  ///< variational: λ below, positive.
  /// Longer pictures are solved in overlapping pieces of half of this, at least 64; see above.
  int largest_piece_px = 2048;
  ProgressCallback progress = {};
};

/// What a shape-from-shading method returns.
struct ShadingResult {
  std::vector<double> height_px;  ///< width · height, row by row, in pixels, mean 0, outward positive; always finite.
  Trace trace;                    ///< Root mean square of I/albedo − R after each step.
  StopReason stop = StopReason::iteration_limit;
  std::array<int, 2> pieces = {1, 1};  ///< Across and down, that were solved one by one.
};

/// Takes the heights in pixels of row y; called once for every row, in any order.
using HeightWriter = std::function<void(int y, std::span<const double> heights_px)>;

/// Integrable surface that minimises
///   E(Z) = Σ (I/albedo − max(0, R(p, q)))² + λ Σ (ΔZ)²
/// over heights (not slopes, so that it is integrable by construction), p and q by central differences.
/// λ is lowered in four stages from 512 times its final value. Each stage is L-BFGS preconditioned by the inverse of
/// the linearised energy in Fourier (periodic) or cosine space: every step is two transforms, whatever the scale of the
/// relief. The energy of a stage never rises. Pictures of 192 pixels a side or more are solved at half their size
/// first, down to 96 to 191 pixels, and take a tenth of the steps at each finer level; the trace runs through all
/// levels. One picture does not distinguish convex under one light from concave under the opposite one: the light
/// decides.
/// Waves across the light direction shade only to second order. Frontal light is ambiguous: the start takes bright as
/// high. Mean depth error on known reliefs under oblique light: see the tests and the report of the benchmark. Cost:
/// about 0.1 s at 256², 1.1 s at 1024². Deterministic.
/// @throws InvalidInput when the picture is empty or not finite, or an option is out of range.
/// Horn and Brooks, Shape from Shading, 1989; Frankot and Chellappa, 1988 (integrability).
ShadingResult shape_from_shading_variational(const GreyImage& image, const ShadingOptions& options = {});
/// The same by pieces, of finite samples wherever they lie: the heights go to `write`, their mean as it comes, and not
/// into the result.
ShadingResult shape_from_shading_variational_by_rows(const SampleRows& picture, const ShadingOptions& options,
                                                     const HeightWriter& write);

/// Pentland's linear method: for gentle slopes R ≈ s_z − s_x p − s_y q, so that in Fourier space
///   Z = conj(D) I / (|D|² + δ² |ω|² |(s_x, s_y)|²),  D = −i (s_x ω_x + s_y ω_y),  δ = 0.1,
/// δ damping waves along which the light does not shade. Exact to first order for light along the slopes, one pair of
/// transforms, no steps. Steep slopes, frontal light (taken as for tsai-shah) and waves across the light break it. A
/// picture that does not tile is continued by its mean over a quarter of its sides.
/// The trace holds the residual of the result. `iterations` and `smoothness` have no effect.
/// Cost: two transforms. Deterministic.
/// @throws InvalidInput as shape_from_shading_variational().
/// Pentland, Linear shape from shading, Int. J. Comp. Vision 4, 1990.
ShadingResult shape_from_shading_pentland(const GreyImage& image, const ShadingOptions& options = {});
/// The same by pieces, of finite samples wherever they lie: the heights go to `write`, their mean as it comes, and not
/// into the result.
ShadingResult shape_from_shading_pentland_by_rows(const SampleRows& picture, const ShadingOptions& options,
                                                  const HeightWriter& write);

/// What shape_from_shading_wiener() returns.
struct WienerShadingResult : ShadingResult {
  /// Of the heights with the true ones, if the light is right; from the spectrum of the picture, see below.
  double expected_correlation = 0;
};

/// Pentland's linear method with the damping that the picture itself asks for:
///   Z = conj(D) I / (|D|² + (N/S) |ω|² |(s_x, s_y)|²),
/// Wiener's filter for slopes of power S(ω) under noise of power N(|ω|). Shading of slopes varies with the angle θ
/// between wave and light as cos²θ, noise and spots of the albedo do not: P(ω) = S cos²θ + N tells them apart in rings
/// of equal |ω|, from the medians over angles; peaks above that, those of a lattice, are added to S. N/S is at least
/// 0.01. Brightness beyond what the light can make (highlights) counts as that of a surface that faces it.
/// The relief is taken as isotropic but for its peaks, the noise as isotropic. The spectrum is that of the middle 1024
/// pixels at most. Pieces, memory and trace as for pentland; cost: four transforms. Deterministic.
/// @throws InvalidInput as shape_from_shading_variational().
/// Pentland 1990; Wiener, Extrapolation, Interpolation and Smoothing of Stationary Time Series, 1949.
WienerShadingResult shape_from_shading_wiener(const GreyImage& image, const ShadingOptions& options = {});
/// The same by pieces, of finite samples wherever they lie: the heights go to `write`, their mean as it comes, and not
/// into the result.
WienerShadingResult shape_from_shading_wiener_by_rows(const SampleRows& picture, const ShadingOptions& options,
                                                      const HeightWriter& write);

/// Tsai and Shah's local method: p = Z(x, y) − Z(x−1, y), q = Z(x, y) − Z(x, y−1), and for every pixel
///   Z ← Z − K f,  f = I/albedo − max(0, R(p, q)),  K = S f′ / (W + S f′²),  S ← (1 − K f′) S,
/// f′ = df/dZ with the neighbours held (Jacobi). The published step Z − f/f′ divides by zero at frontal light
/// and wherever f′ changes sign; the damped gain (W = 1e-8, S starts at 0.01) is finite everywhere.
/// Light less than 0.01 off the viewing direction is taken as (0.01, 0.01, 1), as the source does: at exactly frontal
/// light the flat start would stay flat.
/// Fast, local, noisy: kept as the source's method, `variational` has half its error.
/// I/albedo is taken as at most ±1e6: R is at most 1, so that beyond this only the sign counts.
/// Cost: O(pixels) a step; all steps of a row are taken in the cache, which takes 8 bytes a column and step. A periodic
/// picture costs `iterations` − 1 rows more. Deterministic.
/// @throws InvalidInput as shape_from_shading_variational().
/// Tsai and Shah, Shape from shading using linear approximation, 1994; Schulze 2005, equations 8.1 to 8.5.
ShadingResult shape_from_shading_tsai_shah(const GreyImage& image, const ShadingOptions& options = {});
/// The same by pieces, of finite samples wherever they lie: the heights go to `write`, their mean as it comes, and not
/// into the result.
ShadingResult shape_from_shading_tsai_shah_by_rows(const SampleRows& picture, const ShadingOptions& options,
                                                   const HeightWriter& write);

}  // namespace papilla
