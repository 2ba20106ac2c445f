// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/primitive.hpp"

namespace papilla {

/// The 17 groups of the plane with two translations, by their short names.
enum class WallpaperGroup { p1, p2, pm, pg, cm, pmm, pmg, pgg, cmm, p4, p4m, p4g, p3, p3m1, p31m, p6, p6m };

/// The short name, for example "p4m".
std::string_view to_string(WallpaperGroup group) noexcept;

/// Options of find_wallpaper_group().
struct WallpaperOptions {
  double metric_tolerance = 0.03;  ///< By how much lengths may change under a rotation or reflection, in (0, 0.2].
  double model_error = 0.03;       ///< Share of the variance a group may leave per freed parameter, in (0, 1).
};

/// One group tried.
struct WallpaperCandidate {
  WallpaperGroup group = WallpaperGroup::p1;
  double kept = 1;       ///< Share of the primitive's variance that averaging over the group keeps.
  double criterion = 0;  ///< The information criterion; the least one wins.
};

/// What find_wallpaper_group() returns.
struct WallpaperSymmetry {
  WallpaperGroup group = WallpaperGroup::p1;
  int order = 1;        ///< Rotations and reflections of the group, without its translations.
  double kept = 1;      ///< See WallpaperCandidate.
  Vec2 origin_px{};     ///< A centre of the highest rotation, or a point of a mirror or glide line; from the centre of
                        ///< the picture's first pixel.
  GreyImage primitive;  ///< The primitive averaged over the group: sampled as the one given, bit-equal borders stay so.
  /// Corners of the smallest generating region: a convex polygon of 1/order of the cell, whose images under the group
  /// cover the plane once. Mirror lines bound it.
  std::vector<Vec2> region_px;
  std::vector<WallpaperCandidate> candidates;  ///< Best first; the same group may appear in two orientations.
};

/// Finds the wallpaper group of a texture from its mean cell.
/// Every subgroup P of the rotations and reflections that keep the lattice, with every way of adding glides (t of the
/// first reflection in {0, ½}²), is tried at the origin o that suits it best: averaging the cell over the
/// group leaves
///   R = E − (1/|P|) Σ_g C_g((I − M_g) o + t_g),  C_g(t) = ⟨f, f(M_g⁻¹(· − t))⟩,
/// with the correlations C_g(t) of all translations from one FFT each. Of the groups the one with the least
///   R / s + 2 N / |P|
/// is taken (N Fourier coefficients of the cell, s the noise of one coefficient from the residual of the lattice plus
/// model_error of the mean coefficient): Akaike's criterion in its geometric form, without a threshold on symmetry.
///
/// Good input: a lattice found by find_lattice(), cells of 12 pixels or more, a dozen cells. A cell whose asymmetry is
/// below the noise or below a few percent of its variance is given the higher symmetry. Grey values only.
/// Cost: about 5 ms. Deterministic.
/// @param part symmetric_part() of the picture with the same vectors.
/// @throws InvalidInput when the part is empty or not finite, the vectors span no cell, or an option is out of range.
/// Schulze 2005, section 7.1 (the groups); Kanatani, Statistical Optimization for Geometric Computation, 1996;
/// Moeck, Acta Cryst. A 78, 2022 (the criterion on plane groups).
WallpaperSymmetry find_wallpaper_group(const SymmetricPart& part, const std::array<Vec2, 2>& vectors_px,
                                       const WallpaperOptions& options = {});

}  // namespace papilla
