// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Options of photometric_stereo().
struct PhotometricStereoOptions {
  /// Directions to the lights, one a photograph, any length, z > 0; x right, y down, z to the camera. Empty: unknown.
  std::vector<Vec3> lights = {};
  ProgressCallback progress = {};
};

/// What photometric_stereo() returns.
struct PhotometricStereoResult {
  int width = 0, height = 0;
  std::vector<double> height_px;  ///< Row by row, in pixels, mean 0, outward positive; always finite.
  /// In [0, 1], row by row: 1 where all photographs agree on a slope; lower where one is left out, where more are dark
  /// than can be left out, and where they disagree.
  std::vector<float> confidence;
  std::vector<Vec3> lights;  ///< Used, length 1.
  bool lights_estimated = false;
  double light_uncertainty_deg = 0;  ///< Mean angle between the lights of two halves of the picture; 0 when given.
  double ambient = 0;                ///< Light from everywhere found, relative to a lamp that faces the surface.
  /// The relief and its inverse under the opposite azimuths explain the photographs alike.
  bool two_sided = false;
  double shadows_fraction = 0, highlights_fraction = 0;  ///< Of all pixels of all photographs.
  double residual = 0;  ///< Deviation of a photograph from what the others say, relative to the albedo; 0 for three.
  Trace trace;          ///< Unknown lights: root mean square of the residuals that they are fitted by. Else empty.
  StopReason stop = StopReason::direct;
};

/// Relief from three or more photographs of one place from one point under different lights. With linear brightness
/// I_k, albedo a and normal n, I_k = a n·s_k for a matt surface; pixel by pixel b = a n is the least squares solution,
/// the slopes are p = −b_x/b_z, q = −b_y/b_z, and the heights are the relief whose slopes come closest, with free
/// borders [Frankot and Chellappa 1988]. The albedo may vary as it likes.
///
/// Before that every photograph is divided by its gain, a polynomial of third degree of the logarithm. With four
/// photographs or more any three predict the fourth at every pixel, which only the true gains fulfil where slopes of
/// all directions are near each other; elsewhere the spectrum of the relief says how long waves are probable. Light
/// from everywhere is that with which the mean surface is level. Shadows and highlights are left out where four or
/// more photographs show them in one. What is the same in all photographs, as a vignette, is taken for
/// albedo.
///
/// Unknown lights: the mean surface faces the camera; the two strongest directions of the photographs' differences are
/// the slopes up to a linear transformation, which follows from integrability, ∂p/∂y = ∂q/∂x [Yuille and Snow 1997],
/// and is refined together with the lights by least squares. What remains is the bas-relief ambiguity with two
/// parameters fixed by the mean surface: depth, by the lights' usual elevation and by the brightness of steep places,
/// and sign, by cast shadows where there are some; else `two_sided`, and
/// the side whose shadows fit better is returned.
///
/// Not modelled: light from one facet to another, perspective, lamps so near that their direction changes over the
/// picture by more than a dome would. Three photographs can't tell shadows from slopes.
/// A good input: four or more photographs from a tripod, lamp 25 to 55 degrees above the surface, azimuths spread all
/// around. Cost: about 0.7 s of processor time at 272 × 208 with four lights given. Memory: 8 bytes a pixel and
/// photograph twice, and 150 bytes a pixel. Deterministic.
/// @param photographs  the same size, at least 16 pixels a side, linear brightness (see linear_from_srgb()).
/// @throws InvalidInput when there are fewer than three, their sizes differ, one is black or not finite, or the lights
///         are as many as the photographs not, lie in one plane or come from behind.
/// Woodham, Photometric method for determining surface orientation from multiple images, 1980. Belhumeur, Kriegman and
/// Yuille, The bas-relief ambiguity, 1999.
PhotometricStereoResult photometric_stereo(const std::vector<GreyImage>& photographs,
                                           const PhotometricStereoOptions& options = {});

}  // namespace papilla
