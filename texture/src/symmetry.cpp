// SPDX-License-Identifier: MIT
#include "papilla/texture/symmetry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "even_contrast.hpp"
#include "lattice_surrogates.hpp"
#include "outstanding_wave.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/lattice_agreement.hpp"
#include "papilla/texture/resample.hpp"
#include "pyramid.hpp"

namespace papilla {
namespace {

constexpr int k_most_side = 2048;
constexpr double k_near_cells = 3;
constexpr double k_any_significance = 1e-9;  // The false alarms decide.

/// `options` for lattices that bend: only nodes within `cells` cells count.
LatticeOptions nearby(const LatticeOptions& options, double cells) {
  LatticeOptions near = options;
  near.least_significance = k_any_significance;
  near.reach_cells = cells;
  return near;
}

/// A lattice found on the straightened picture.
struct BentLattice {
  Lattice lattice;
  LatticeDeformation deformation;
  GreyImage straight;
  double quality = 0;  ///< Share of the variance explained.
};

/// Straightens the picture by the lattice it starts from, and finds the lattice anew; where that is another one, a
/// part or a multiple of the first, once more from there.
std::optional<BentLattice> straightened_lattice(const GreyImage& picture, Lattice start,
                                                const LatticeOptions& options) {
  constexpr int k_rounds = 2;
  constexpr double k_reach_cells = 4;
  constexpr double k_doubt = 0.1;  // What a lattice that is not confirmed on the straight picture must explain more.
  std::optional<BentLattice> best;
  for (int round = 0; round < k_rounds; ++round) {
    LatticeDeformation deformation = find_lattice_deformation(picture, start.vectors_px);
    if (!deformation.significant) break;
    BentLattice bent{{}, std::move(deformation), {}, 0};
    bent.straight = straightened(picture, bent.deformation.displacement);
    bent.lattice = find_lattice(feature_matrix(bent.straight), nearby(options, k_reach_cells));
    const bool same = is_same_lattice(start, bent.lattice);
    const Lattice other = bent.lattice;
    bent.quality = bent.deformation.explained_after;
    // Vectors from near nodes add up to a drift over a hundred cells.
    const auto explained = [&](const std::array<Vec2, 2>& vectors) {
      return symmetric_part(bent.straight, vectors).explained_variance;
    };
    if (same && explained(bent.deformation.vectors_px) > explained(bent.lattice.vectors_px))
      bent.lattice.vectors_px = bent.deformation.vectors_px;
    if (!same) {
      bent.lattice = start;
      bent.lattice.vectors_px = bent.deformation.vectors_px;
      bent.quality -= k_doubt;
    }
    if (!best || bent.quality > best->quality) best = std::move(bent);
    if (same || !other.found) break;
    start = other;
  }
  return best;
}

std::string chance_text(double probability) {
  const double percent = 100 * probability;
  return percent < 0.01 ? "under 0.01" : std::to_string(std::round(100 * percent) / 100).substr(0, 5);
}

/// Of the lattice of near nodes, and where chance explains that, of the one of all nodes: two tries then.
double false_alarm_probability(const GreyImage& even, const Lattice& near, const Lattice& whole,
                               const LatticeOptions& options) {
  constexpr int k_tries = 2;
  const double rate = options.false_alarm_rate;
  double p = 1;
  if (near.found) p = texture_detail::false_alarm_probability(even, near, nearby(options, k_near_cells), rate);
  if (p <= rate || !whole.found) return p;
  const double all = texture_detail::false_alarm_probability(even, whole, nearby(options, 0), rate / k_tries);
  return near.found ? std::min(1.0, k_tries * std::min(p, all)) : all;
}

/// The best lattices of a picture under even light, by near nodes and by all, and how likely chance makes such.
struct Candidates {
  Lattice near, whole;
  double false_alarm_probability = 1;

  bool holds(double rate) const { return (near.found || whole.found) && false_alarm_probability <= rate; }
};

Candidates candidates(const GreyImage& even, const LatticeOptions& options) {
  const FeatureMatrix matrix = feature_matrix(even);
  Candidates result{find_lattice(matrix, nearby(options, k_near_cells)), find_lattice(matrix, nearby(options, 0)), 1};
  result.false_alarm_probability = false_alarm_probability(even, result.near, result.whole, options);
  return result;
}

/// The same of the picture at half and a quarter of its size, where structure within the cells that repeats by itself
/// (threads within checks) or noise hides the cells; in pixels of the picture. Every try may add a false alarm, so that
/// each has a share of the rate only.
std::optional<Candidates> coarse_candidates(const GreyImage& even, LatticeOptions options) {
  constexpr int k_halvings = 2, k_least_side = 96;
  constexpr double k_share = 0.1;
  options.false_alarm_rate *= k_share;
  GreyImage coarse = even;
  for (int k = 0; k < k_halvings; ++k) {
    coarse = texture_detail::halved(coarse);
    if (std::min(coarse.width, coarse.height) < k_least_side) break;
    Candidates found = candidates(coarse, options);
    if (!found.holds(options.false_alarm_rate)) continue;
    const Vec2 grown{static_cast<double>(even.width) / coarse.width, static_cast<double>(even.height) / coarse.height};
    for (Lattice* lattice : {&found.near, &found.whole})
      for (Vec2& v : lattice->vectors_px) v = {grown.x * v.x, grown.y * v.y};
    return found;
  }
  return std::nullopt;
}

/// Drops the lattice when chance explains it.
void reject(SymmetryAnalysis& analysis) {
  Lattice& lattice = analysis.lattice;
  if (!lattice.found && lattice.stripes > 0) return;
  lattice.found = false;
  lattice.vectors_px = {};
  if (analysis.false_alarm_probability < 1)
    lattice.reason = "the best lattice is not significant: " + chance_text(analysis.false_alarm_probability) +
                     " % of noises with this spectrum repeat as well";
}

/// The lattice of the picture under even light, straightened where it bends.
void follow(SymmetryAnalysis& analysis, const GreyImage& even, const Lattice& near, const Lattice& whole,
            const LatticeOptions& options) {
  constexpr double k_gain = 0.02;  // Of the explained variance, from which on light counts as uneven.
  std::optional<BentLattice> best;
  for (const Lattice& start : {near, whole}) {
    if (!start.found || (best && is_same_lattice(best->lattice, start))) continue;
    std::optional<BentLattice> bent = straightened_lattice(even, start, options);
    if (bent && (!best || bent->quality > best->quality)) best = std::move(bent);
  }
  std::vector<Vec2> minima = std::move(analysis.lattice.minima);
  if (best) {
    analysis.lattice = std::move(best->lattice);
    analysis.deformation = std::move(best->deformation);
    analysis.straight = std::move(best->straight);
    analysis.part = symmetric_part(*analysis.straight, analysis.lattice.vectors_px);
  } else {
    const Lattice& found = whole.found ? whole : near;
    if (!is_same_lattice(analysis.lattice, found)) analysis.lattice = found;
    analysis.part = symmetric_part(analysis.picture, analysis.lattice.vectors_px);
    SymmetricPart lit = symmetric_part(even, analysis.lattice.vectors_px);
    if (lit.explained_variance > analysis.part->explained_variance + k_gain) {
      analysis.lattice = found;
      analysis.straight = even;
      analysis.part = symmetric_part(even, found.vectors_px);
    }
  }
  analysis.lattice.minima = std::move(minima);
}

}  // namespace

SymmetryAnalysis analyze_symmetry(const GreyImage& image, const LatticeOptions& options, FeatureKind feature,
                                  const ProgressCallback& progress) {
  texture_detail::require_image(image, "analyze_symmetry");
  if (!(options.false_alarm_rate > 0 && options.false_alarm_rate <= 1))
    throw InvalidInput("analyze_symmetry: false_alarm_rate " + std::to_string(options.false_alarm_rate) +
                       " is not within (0, 1]");
  SymmetryAnalysis analysis;
  analysis.picture = middle_part(image, k_most_side);
  const bool bends = feature == FeatureKind::squared && options.method == LatticeMethod::best;
  const GreyImage even = texture_detail::with_even_light(analysis.picture);
  constexpr double k_outstanding = 1e-3;
  if (bends && options.false_alarm_rate < 1 && texture_detail::chance_of_highest_wave(even) > k_outstanding) {
    analysis.lattice.reason = "no wave stands out of the spectrum";
    return analysis;
  }
  analysis.matrix = feature == FeatureKind::squared ? feature_matrix(analysis.picture)
                                                    : absolute_feature_matrix(analysis.picture, progress);
  analysis.lattice = find_lattice(analysis.matrix, options);
  Candidates best;
  if (bends) {
    best = candidates(even, options);
    if (!best.holds(options.false_alarm_rate))
      if (std::optional<Candidates> coarse = coarse_candidates(even, options)) best = std::move(*coarse);
  } else {
    best.whole = analysis.lattice;
    best.false_alarm_probability = false_alarm_probability(even, best.near, best.whole, options);
  }
  analysis.false_alarm_probability = best.false_alarm_probability;
  if (!best.holds(options.false_alarm_rate)) {
    reject(analysis);
  } else if (bends) {
    follow(analysis, even, best.near, best.whole, options);
  } else {
    analysis.part = symmetric_part(analysis.picture, analysis.lattice.vectors_px);
  }
  return analysis;
}

WallpaperSymmetry find_wallpaper_group(const SymmetryAnalysis& analysis, const WallpaperOptions& options) {
  if (!analysis.part) throw InvalidInput("find_wallpaper_group: the picture has no lattice");
  // The mean of displaced cells is known to about their displacement over the number of them.
  constexpr double k_share = 0.6, k_most = 0.15;
  WallpaperOptions wide = options;
  if (analysis.deformation)
    wide.metric_tolerance = std::max(
        options.metric_tolerance,
        std::min(k_most, options.metric_tolerance + k_share * analysis.deformation->rms_percent_of_cell / 100));
  return find_wallpaper_group(*analysis.part, analysis.lattice.vectors_px, wide);
}

}  // namespace papilla
