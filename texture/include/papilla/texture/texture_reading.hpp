// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "papilla/core/deadline.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/symmetry.hpp"
#include "papilla/texture/texture_class.hpp"
#include "papilla/texture/wallpaper_group.hpp"

namespace papilla {

/// Options of read_texture().
struct ReadingOptions {
  LatticeOptions lattice;
  FeatureKind feature = FeatureKind::squared;
  bool roughness = true;   ///< Measure the dimension where the class asks for it.
  Deadline deadline = {};  ///< Of searches, which are not begun after it; those that have begun take 5 us a pixel.
  ProgressCallback progress = {};
};

/// What a picture is, as far as its class asks for it; see read_texture().
struct TextureReading {
  SymmetryAnalysis symmetry;
  std::optional<WallpaperSymmetry> group;  ///< Of a picture with a lattice.
  TextureClass kind;
  Suitability suitability;
  std::optional<BestDimension> roughness;  ///< Of what is disordered: the picture, or what its lattice leaves.
  StopReason stop = StopReason::direct;    ///< `time_limit` when something was not looked for.
  AnalysisPlan plan;                       ///< Of plan_analysis(); its steps are those that were or shall be run.
};

/// Carries out the part of the plan of a picture's class [plan_analysis()] that measures: the search for a lattice, the
/// class, then the group of a picture with a lattice, the dimension of one that has something disordered. What the
/// class makes needless is not computed, and the plan says why. Cost: that of analyze_symmetry() and of the steps run.
/// Deterministic.
/// @throws InvalidInput when the picture is empty or not finite.
/// Schulze 2005, section 5.8 (Rao's taxonomy as a plan).
TextureReading read_texture(const GreyImage& image, const ReadingOptions& options = {});

/// The step of that name. @throws InvalidInput when the plan has none.
const PlanStep& step_of(const AnalysisPlan& plan, std::string_view step);

}  // namespace papilla
