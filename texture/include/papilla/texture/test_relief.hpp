// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "papilla/texture/height_map.hpp"

namespace papilla {

/// Options of test_relief().
struct TestReliefOptions {
  int width = 288, height = 224;  ///< Samples, 64 to 4096 a side.
  double pitch_mm = 0.1;
  double rms_slope = 0.25;  ///< Root mean square of the gradient, millimetres per millimetre.
  std::uint64_t seed = 1;   ///< Of the irregular ones, and of how far the regular ones are moved.
};

/// Reliefs that photographs are simulated of, oblong and not periodic over the picture:
///   spheres, quads, ovals, sine, gaussian, fourier, leather   as synthesize_grain()
///   fractal    self-affine with H = 0.7 and waves of 4 samples to half the picture
///   weave      threads that cross over and under, turned by 17 degrees, closer together one way
///   ribs       rounded ridges at 33 degrees whose distance varies
///   dents      round pits of several sizes in level ground
///   emboss     flat raised strokes with soft flanks
///   scales     shingles that rise slowly and fall steeply, turned by 62 degrees
///   knurl      four-sided pyramids, oblong, turned by 24 degrees
///   honeycomb  six-sided walls around hollows
///   pebbles    domes of several sizes at random places
/// @throws InvalidInput for any other name, or an option out of range.
HeightMap test_relief(std::string_view name, const TestReliefOptions& options = {});

/// The names of all test reliefs, in the order above.
std::vector<std::string_view> test_relief_names();

}  // namespace papilla
