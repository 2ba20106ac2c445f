// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/texture/image.hpp"
#include "papilla/texture/lattice.hpp"

namespace papilla {

/// Taxonomy of textures [Rao, A Taxonomy for Texture Description and Identification, 1990].
enum class TextureKind {
  disordered,
  weakly_ordered,
  strongly_ordered_symmetric,
  strongly_ordered_nonsymmetric,
  composite
};

/// The kind's name as reports print it, for example "strongly_ordered_symmetric".
std::string_view to_string(TextureKind kind) noexcept;

/// Shares of the variance that repeats from which classify() calls a picture strongly ordered, and composite.
inline constexpr double k_strong_share = 0.5, k_composite_share = 0.15;

/// Shares of a picture's variance by order; they add up to 1.
struct TextureClass {
  TextureKind kind = TextureKind::disordered;
  double disordered = 1;        ///< The rest: roughness.
  double weakly_ordered = 0;    ///< What the lattice leaves, times the coherence of the picture's orientation.
  double strongly_ordered = 0;  ///< Explained by the mean cell of the lattice, or repeated in one direction only.
};

/// The source's tests of whether grey values may be read as a fractal height map (its section 6.2).
struct Suitability {
  bool homogeneous = false;  ///< Mean and contrast of the picture's 16 blocks agree.
  bool directional = false;  ///< The grey gradient prefers a direction.
  bool symmetric = false;    ///< The picture has a lattice.
  bool flat = false;         ///< All pixels are equal.
};

/// One step of the analysis of a texture and whether its class needs it.
struct PlanStep {
  std::string step;
  bool run = false;
  std::string reason;
};
using AnalysisPlan = std::vector<PlanStep>;

/// Class of a picture from the variance its lattice explains (0 without lattice), the share that repeats in one
/// direction only (Lattice::stripes), and the coherence of its structure tensor. strongly_ordered_symmetric from an
/// explained share of k_strong_share on, composite from k_composite_share on; strongly_ordered_nonsymmetric where
/// stripes repeat from k_strong_share on; weakly_ordered from a coherence of 0.4 on. Elements placed by a rule without
/// any translation (bricks of different size) count as disordered. Cost: O(pixels). @throws InvalidInput when the
/// picture is empty or not finite.
TextureClass classify(const GreyImage& image, double explained_variance, double stripes = 0);

/// Local orientation of a weakly ordered texture, block by block.
struct OrientationField {
  int columns = 0, rows = 0;
  std::vector<double> angle_deg;  ///< Along the structure (across the grey gradient), from x towards y, in [0, 180).
  std::vector<double> coherence;  ///< 0 without direction, 1 for stripes.
  double mean_coherence = 0;      ///< Weighted by the gradients' energy.
  double spread =
      1;  ///< 0 when all blocks agree, 1 when they point everywhere: 1 − |mean of coherence · exp(2iφ)| / mean.
};

/// Structure tensor over blocks of 32 pixels or an eighth of the side, whichever is more.
/// Cost: O(pixels). @throws InvalidInput when the picture is empty or not finite.
/// Kass and Witkin, Analyzing oriented patterns, 1987.
OrientationField orientation_field(const GreyImage& image);

/// See Suitability. Cost: O(pixels). @throws InvalidInput when the picture is empty or not finite.
Suitability measure_suitability(const GreyImage& image, const Lattice& lattice);

/// Which steps from picture to height map a texture of that class needs, in order, each with its reason.
AnalysisPlan plan_analysis(const TextureClass& texture_class, const Suitability& suitability);

/// True when the colours of a picture differ from grey or one hue by little: mean distance of the pixels from the
/// straight line through their mean colour that fits them best, below 3 % of the range.
/// @throws InvalidInput when the picture is empty.
bool is_monochrome(const ColorImage& image);

}  // namespace papilla
