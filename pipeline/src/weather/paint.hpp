// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/procedural/texture.hpp"
#include "weather/own_surface.hpp"
#include "weather/surface_texels.hpp"

namespace papilla {

/// What a window is painted with.
struct PaintJob {
  const ProceduralTexture& texture;
  const SurfaceReading& reading;
  const OwnSurface& own;
  double depth_mm;     ///< Of a height of 1.
  bool tiles = false;  ///< Windows go on round their borders.
};

/// Sums over the texels that something shows, so that means can be told.
struct Felt {
  double friction = 0, stiffness = 0, texels = 0;
};

/// A painted window: byte and height a texel.
struct Painted {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
  std::vector<float> bump;
};

/// Evaluates the recipe at the covered texels of a window; the others get a middle grey and height.
/// @param sky  of the window; empty when it is not read. @param scale  texels a repeat.
/// @param charts  how often the window is shown, for the means.
Painted paint(const PaintJob& job, const SurfaceTexels& texels, const std::vector<float>& sky, double scale,
              double charts, Felt& felt);

}  // namespace papilla
