// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// A ball that lies beside the sample, as the picture shows it.
struct LightSphere {
  Vec2 centre_px;
  double radius_px = 0;
  bool mirror = false;  ///< A polished ball; else a matt one.
};

/// Direction to the light from a ball in the picture, length 1; x right, y down, z to the camera.
/// Mirror: the centre of the brightest pixels, at least half as bright as the brightest, is where the light is
/// reflected to the camera: with n the normal there, s = 2 (n·z) n − z. Matt: least squares of I = a n·s + c over the
/// pixels of the lit side, those brighter than a quarter of the brightest.
/// The camera is far away.
/// @param photograph  linear brightness. @throws InvalidInput when the ball is not inside the picture, its radius is
///        below 4 pixels, or it shows no light.
Vec3 light_of_sphere(const GreyImage& photograph, const LightSphere& sphere);

}  // namespace papilla
