// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/pipeline/felt_waves.hpp"
#include "papilla/texture/fractal_readings.hpp"
#include "papilla/texture/frieze_group.hpp"
#include "papilla/texture/lattice_agreement.hpp"
#include "papilla/texture/symmetry.hpp"
#include "papilla/texture/texture_class.hpp"
#include "papilla/texture/wallpaper_group.hpp"

namespace papilla {

/// What a picture is taken for when its symmetry is determined: a part of the plane, a strip along x, one motif about
/// the middle of the picture. The last two are determined in addition to the wallpaper group.
enum class SymmetryPattern { plane, strip, rosette };

/// Options of survey_picture().
struct SurveyOptions {
  bool fractal = true, symmetry = true, order = true;  ///< The analyses to run.
  bool by_class = true;  ///< Leave out what the picture's class makes needless; with all three analyses only.
  SymmetryPattern pattern = SymmetryPattern::plane;
  LatticeOptions lattice;
  FeatureKind feature = FeatureKind::squared;
  double pitch_mm = 0;             ///< Millimetres per pixel; 0: from the file's resolution.
  int largest_px = 4096;           ///< Longer pictures are read in pieces of at most half of this.
  std::filesystem::path pictures;  ///< Folder for TextureSurvey::pictures; empty: none are drawn.
};

/// Symmetry groups of the part of the picture that is analysed.
struct SymmetryGroups {
  std::optional<WallpaperSymmetry> plane;  ///< Of a picture with a lattice.
  std::optional<FriezeSymmetry> strip;     ///< With SymmetryPattern::strip.
  std::optional<RosetteSymmetry> rosette;  ///< With SymmetryPattern::rosette.
};

/// The class of a texture, the measurements it follows from, and the steps that it needs.
struct OrderSurvey {
  TextureClass kind;
  OrientationField orientation;
  Suitability suitability;
  bool monochrome = false;
  AnalysisPlan plan;
};

/// The pieces of a picture too large to be held in memory.
struct PieceSurvey {
  int columns = 1, rows = 1;
  LatticeAgreement lattice;
};

/// What hands get of a picture's waves under a stroke. Heights are not known, so nothing is said of thresholds.
struct TouchSurvey {
  double speed_m_per_s = 0;                                        ///< TouchOptions::speed_m_per_s.
  double slowest_hz = 0, fastest_hz = 0;                           ///< Of the longest and the shortest wave.
  std::array<double, k_touch_receptors.size()> receptor_shares{};  ///< Of the variance of grey, in each band.
  double unfelt_share = 0;                                         ///< Faster than all bands.
  int needed_width = 0, needed_height = 0;  ///< Pixels of the picture that even a slow stroke can tell apart.
};

/// A file that shows a result.
struct SurveyPicture {
  std::string name, file;
  bool drawn = true;  ///< False: gnuplot, which draws it, is not installed.
};

struct TextureSurvey {
  int width = 0, height = 0, bits = 0;
  double pitch_mm = 0;  ///< 0: unknown.
  GreyImage middle;     ///< What the symmetry is read from: the picture, or its middle.
  std::optional<PieceSurvey> pieces;
  std::optional<FractalReadings> fractal;
  std::string no_fractal;                    ///< Why there are no fractal readings although they were asked for.
  std::optional<SymmetryAnalysis> symmetry;  ///< For the groups, the class or the pictures.
  std::optional<SymmetryGroups> groups;      ///< With SurveyOptions::symmetry.
  std::optional<OrderSurvey> order;
  std::optional<TouchSurvey> touch;  ///< With SurveyOptions::by_class, of a picture with a pitch.
  std::vector<SurveyPicture> pictures;
};

/// Reads a picture of any size and analyses it. Up to `largest_px` a side it is held as a whole. Larger ones are read
/// from top to bottom in bands, cut into pieces each of which is analysed: fractal dimensions are the means over the
/// pieces, class and suitability follow from all of them, and the lattice is that of the middle of the picture, which
/// counts if at least half of the pieces have the same one. Memory: a band (at most 2^26 pixels) and one piece,
/// whatever the picture; time grows with the pixels.
/// The pictures are symmetry.png (symmetry_strip() with captions) and, with a fractal dimension, log-log.svg and
/// hurst.svg.
/// @throws IoError, InvalidInput as ImageBands; IoError when a picture can't be written; InvalidInput too when the
/// picture is wider than 524288 pixels and higher than a band of 128 rows.
TextureSurvey survey_picture(const std::filesystem::path& path, const SurveyOptions& options,
                             const ProgressCallback& progress = {});

/// A method's name, the shortest side in pixels that it reads, and what it finds: null in smaller pictures.
struct FractalReading {
  std::string_view name;
  int least_side;
  const FractalEstimate* estimate;       ///< Null, too, for `best` without a power law.
  const std::vector<ScalePoint>* curve;  ///< The log-log plot.
  std::string_view none = "";            ///< Why `best` has no estimate, empty when it has one.

  /// Says a dimension: what leaves [2, 3] is no dimension of a surface.
  bool has_dimension() const { return estimate != nullptr && estimate->is_of_surface(); }
};

/// All readings by name. @param readings must outlive them.
std::array<FractalReading, 6> named_readings(const FractalReadings& readings);

}  // namespace papilla
