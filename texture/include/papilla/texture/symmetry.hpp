// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "papilla/core/progress.hpp"
#include "papilla/texture/feature_matrix.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/lattice.hpp"
#include "papilla/texture/lattice_deformation.hpp"
#include "papilla/texture/primitive.hpp"
#include "papilla/texture/wallpaper_group.hpp"

namespace papilla {

/// What analyze_symmetry() returns.
struct SymmetryAnalysis {
  GreyImage picture;     ///< The part of the picture that was analysed.
  FeatureMatrix matrix;  ///< Of `picture`; empty where its spectrum is flat, so that no lattice was sought.
  Lattice lattice;       ///< Of `picture`; where it bends, with the mean cell.
  /// How often noise with the picture's spectrum, the lattice's waves taken out, repeats as well; 1 where nothing does.
  double false_alarm_probability = 1;
  std::optional<LatticeDeformation> deformation;  ///< Where the lattice bends.
  std::optional<GreyImage> straight;  ///< `picture` under even light and straightened, where it needed either.
  std::optional<SymmetricPart> part;  ///< With a lattice: primitive, synthesis and residual of regular().

  /// The picture that the lattice fits: straight, or as given.
  const GreyImage& regular() const { return straight ? *straight : picture; }
  double explained_variance() const { return part ? part->explained_variance : 0; }
};

/// Which distortion the feature matrix holds: feature_matrix() or absolute_feature_matrix().
enum class FeatureKind { squared, absolute };

/// Lattice and mean cell of a picture, whether the lattice is exact or bends, under even light or not.
/// The light's fall-off is taken away (quadrics of mean and deviation); a lattice is sought from the nodes within three
/// cells and from all; it counts when at most LatticeOptions::false_alarm_rate of the noises with the picture's own
/// spectrum reach its significance [Theiler et al., surrogate data]. Then its deformation is found
/// (find_lattice_deformation()), and, where that explains more than chance, lattice and mean cell are those of the
/// straightened picture. Exact lattices keep the vectors that find_lattice() gives for the whole matrix.
/// Where no wave stands out of the spectrum (as high a one in more than 1 of 1000 noises with a spectrum that depends
/// on the wave number alone), nothing can repeat and nothing is sought, unless the rate is 1. Lattices bent by a tenth
/// of their cell, under light that falls off by half, blurred and with noise, have waves that one in e^40 noises has.
/// Where none counts, the picture at half and at a quarter of its size is tried, each at a tenth of the rate.
/// LatticeMethod::projection and FeatureKind::absolute know neither even light nor bending.
///
/// Good input: three cells a side or more, of 4 pixels or more, neighbours of which differ by less than a quarter of a
/// cell. Strong perspective, dislocations, and bonds that change from row to row are not followed.
/// Pictures over 2048 pixels a side are analysed in their centred 2048 × 2048 pixels, which bounds time and memory.
/// Cost: at 256² about 0.1 s without a lattice or with an exact one, 0.2 s with one that bends. Deterministic.
/// @throws InvalidInput when the picture is empty or not finite, or an option is out of range.
SymmetryAnalysis analyze_symmetry(const GreyImage& image, const LatticeOptions& options = {},
                                  FeatureKind feature = FeatureKind::squared, const ProgressCallback& progress = {});

/// The wallpaper group of the mean cell. Where the lattice bends, lengths and angles of the cell are only as sure as
/// the displacements allow: the metric tolerance grows by 0.6 of their root mean square, up to 0.15.
/// @throws InvalidInput when there is no lattice.
WallpaperSymmetry find_wallpaper_group(const SymmetryAnalysis& analysis, const WallpaperOptions& options = {});

}  // namespace papilla
