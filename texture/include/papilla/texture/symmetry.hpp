// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "papilla/core/progress.hpp"
#include "papilla/texture/feature_matrix.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/lattice.hpp"
#include "papilla/texture/lattice_deformation.hpp"
#include "papilla/texture/primitive.hpp"

namespace papilla {

/// What analyze_symmetry() returns.
struct SymmetryAnalysis {
  GreyImage picture;     ///< The part of the picture that was analysed.
  FeatureMatrix matrix;  ///< Of `picture`.
  Lattice lattice;
  std::optional<LatticeDeformation> deformation;  ///< Where the lattice bends: then `part` is that of `straight`.
  std::optional<GreyImage> straight;
  double false_alarm_probability = 1;
  std::optional<SymmetricPart> part;  ///< With a lattice: primitive, synthesis and residual of `picture`.

  double explained_variance() const { return part ? part->explained_variance : 0; }
};

/// Which distortion the feature matrix holds: feature_matrix() or absolute_feature_matrix().
enum class FeatureKind { squared, absolute };

/// Feature matrix, lattice and mean cell of a picture in one go. Pictures over 2048 pixels a side are analysed in
/// their centred 2048 × 2048 pixels, which bounds time and memory.
/// Cost: about 10 ms at 256². Deterministic. @throws InvalidInput when the picture is empty or not finite.
SymmetryAnalysis analyze_symmetry(const GreyImage& image, const LatticeOptions& options = {},
                                  FeatureKind feature = FeatureKind::squared, const ProgressCallback& progress = {});

}  // namespace papilla
