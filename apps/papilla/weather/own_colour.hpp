// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>

#include "papilla/io/scene.hpp"
#include "papilla/texture/image.hpp"

namespace papilla::app {

/// A material's base colour as stored (sRGB): its picture, repeated, times its factor.
class OwnColour {
 public:
  /// @throws InvalidInput when the picture can't be decoded.
  OwnColour(const Scene& scene, const Material& material);
  /// Bilinear. @param u, v  in repeats, v down the rows; finite.
  std::array<float, 3> at(double u, double v) const;

 private:
  std::array<float, 3> tint_{};
  std::optional<ColorImage> picture_;
};

}  // namespace papilla::app
