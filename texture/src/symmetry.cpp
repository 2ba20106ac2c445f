// SPDX-License-Identifier: MIT
#include "papilla/texture/symmetry.hpp"

#include "checks.hpp"
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
  analysis.lattice = find_lattice(analysis.matrix, options);
  if (analysis.lattice.found) analysis.part = symmetric_part(analysis.picture, analysis.lattice.vectors_px);
  return analysis;
}

}  // namespace papilla
