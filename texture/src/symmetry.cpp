// SPDX-License-Identifier: MIT
#include "papilla/texture/symmetry.hpp"

#include <algorithm>

#include "checks.hpp"

namespace papilla {
namespace {

constexpr int k_most_side = 2048;

GreyImage centre_of(const GreyImage& image) {
  const int width = std::min(image.width, k_most_side), height = std::min(image.height, k_most_side);
  if (width == image.width && height == image.height) return image;
  GreyImage part{width, height, {}, image.pitch_mm, image.bits};
  const int left = (image.width - width) / 2, top = (image.height - height) / 2;
  for (int y = 0; y < height; ++y)
    part.pixels.insert(part.pixels.end(),
                       image.pixels.begin() + static_cast<std::ptrdiff_t>(image.index(left, top + y)),
                       image.pixels.begin() + static_cast<std::ptrdiff_t>(image.index(left, top + y)) + width);
  return part;
}

}  // namespace

SymmetryAnalysis analyze_symmetry(const GreyImage& image, const LatticeOptions& options, FeatureKind feature) {
  texture_detail::require_image(image, "analyze_symmetry");
  SymmetryAnalysis analysis;
  analysis.picture = centre_of(image);
  analysis.matrix =
      feature == FeatureKind::squared ? feature_matrix(analysis.picture) : absolute_feature_matrix(analysis.picture);
  analysis.lattice = find_lattice(analysis.matrix, options);
  if (analysis.lattice.found) analysis.part = symmetric_part(analysis.picture, analysis.lattice.vectors_px);
  return analysis;
}

}  // namespace papilla
