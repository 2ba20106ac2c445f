// SPDX-License-Identifier: MIT
#include "papilla/texture/symmetry.hpp"

#include <cstdio>
#include <cstdlib>

#include "checks.hpp"
#include "even_light.hpp"
#include "papilla/texture/lattice_agreement.hpp"
#include "lattice_surrogates.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/texture/resample.hpp"

namespace papilla {
namespace {

constexpr int k_most_side = 2048;

}  // namespace

SymmetryAnalysis analyze_symmetry(const GreyImage& image, const LatticeOptions& options, FeatureKind feature,
                                  const ProgressCallback& progress) {
  texture_detail::require_image(image, "analyze_symmetry");
  SymmetryAnalysis analysis;
  analysis.picture = middle_part(image, k_most_side);
  analysis.matrix = feature == FeatureKind::squared ? feature_matrix(analysis.picture)
                                                    : absolute_feature_matrix(analysis.picture, progress);
  const GreyImage even = texture_detail::with_even_light(analysis.picture);
  const FeatureMatrix even_matrix = feature_matrix(even);
  LatticeOptions near = options;
  near.least_significance = 0.01;
  near.reach_cells = 3;
  LatticeOptions all = options;
  all.least_significance = 0.01;
  const Lattice whole = find_lattice(even_matrix, all);
  const Lattice part = find_lattice(even_matrix, near);
  const bool talk = std::getenv("TALK") != nullptr;
  const auto show = [&](const char* name, const Lattice& l) {
    if (talk) std::printf("   %s found %d sig %.3f (%.2f %.2f)(%.2f %.2f)\n", name, l.found, l.significance, l.vectors_px[0].x, l.vectors_px[0].y, l.vectors_px[1].x, l.vectors_px[1].y);
  };
  show("whole", whole);
  show("near", part);
  analysis.lattice = whole;
  {
    const Stopwatch clock;
    analysis.false_alarm_probability = part.found ? texture_detail::false_alarm_probability(even, part, near, 0.01) : texture_detail::false_alarm_probability(even, whole, all, 0.01);
    if (talk) std::printf("   P %.5f %.3f s\n", analysis.false_alarm_probability, clock.seconds());
  }
  GreyImage straight = even;
  std::vector<Lattice> starts;
  if (part.found) starts.push_back(part);
  if (whole.found && !is_same_lattice(part, whole)) starts.push_back(whole);
  if (std::getenv("NODEF") || analysis.false_alarm_probability > 0.01) { starts.clear(); if(analysis.false_alarm_probability > 0.01) analysis.lattice={}; }
  LatticeOptions flatopt = all;
  flatopt.reach_cells = 4;
  double best = -1;
  for (Lattice start : starts) {
    if (best >= 0 && is_same_lattice(start, analysis.lattice)) break;
    for (int round = 0; round < 2; ++round) {
      LatticeDeformation d = find_lattice_deformation(even, start.vectors_px);
      if (talk)
        std::printf("   before %.3f after %.3f signif %d rms %.2f max %.2f vectors (%.2f %.2f)(%.2f %.2f) %.3f s\n", d.explained_before, d.explained_after, d.significant, d.rms_percent_of_cell, d.max_percent_of_cell, d.vectors_px[0].x, d.vectors_px[0].y, d.vectors_px[1].x, d.vectors_px[1].y, d.trace.back().seconds);
      if (!d.significant) break;
      const GreyImage flat = straightened(even, d.displacement);
      const Lattice found = find_lattice(feature_matrix(flat), flatopt);
      show("straight", found);
      if (!found.found) break;
      const double quality = d.explained_after;
      const bool same = is_same_lattice(start, found);
      if (quality > best && same) {
        best = quality;
        straight = flat;
        analysis.lattice = found;
        analysis.deformation = d;
      }
      if (same) break;
      start = found;
    }
  }
  if (analysis.deformation) analysis.straight = straight;
  if (analysis.lattice.found) analysis.part = symmetric_part(straight, analysis.lattice.vectors_px);
  return analysis;
}

}  // namespace papilla
