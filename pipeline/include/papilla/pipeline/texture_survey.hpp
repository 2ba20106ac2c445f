// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "papilla/core/progress.hpp"
#include "papilla/texture/fractal_readings.hpp"
#include "papilla/texture/lattice_agreement.hpp"
#include "papilla/texture/symmetry.hpp"
#include "papilla/texture/texture_class.hpp"

namespace papilla {

/// What survey_picture() shall find out.
struct SurveyOptions {
  bool fractal = true, symmetry = true, order = true;
  LatticeOptions lattice;
  FeatureKind feature = FeatureKind::squared;
  int largest_px = 4096;  ///< Longer pictures are read in pieces of at most half of this.
};

/// Class and what it rests on.
struct OrderSurvey {
  TextureClass kind;
  OrientationField orientation;
  Suitability suitability;
  bool monochrome = false;
};

/// The pieces of a picture too large to be held.
struct PieceSurvey {
  int columns = 1, rows = 1;
  LatticeAgreement lattice;
};

struct TextureSurvey {
  int width = 0, height = 0, bits = 0;
  double pitch_mm = 0;
  GreyImage middle;  ///< What the symmetry is read from: the picture, or its middle.
  std::optional<PieceSurvey> pieces;
  std::optional<FractalReadings> fractal;
  std::optional<SymmetryAnalysis> symmetry;
  std::optional<OrderSurvey> order;
};

/// Reads a picture of any size and analyses it. Up to `largest_px` a side it is held as a whole. Larger ones are read
/// from top to bottom in bands, cut into pieces each of which is analysed: fractal dimensions are the means over the
/// pieces, class and suitability follow from all of them, and the lattice is that of the middle of the picture, which
/// counts if at least half of the pieces say the same. Memory: a band (at most 2^26 pixels) and one piece, whatever the
/// picture; time grows with the pixels.
/// @throws IoError, InvalidInput as ImageBands; InvalidInput too when the picture is wider than 524288 pixels and
/// higher than a band of 128 rows.
TextureSurvey survey_picture(const std::filesystem::path& path, const SurveyOptions& options,
                             const ProgressCallback& progress);

}  // namespace papilla
