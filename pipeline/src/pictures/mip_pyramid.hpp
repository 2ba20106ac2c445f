// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// A picture at halving resolutions, sampled with repeat and bilinear interpolation.
class MipPyramid {
 public:
  /// @param encoded_srgb colours are linearised, so that averages keep the brightness.
  MipPyramid(const ColorImage& image, bool encoded_srgb);

  /// The mean colour over about `texels` texels of the full picture (an area), components in [0, 1]. uv (0, 0) is the
  /// bottom left corner, v grows upwards, as in scenes.
  Vec3 sample(Vec2 uv, double texels) const;

  double texel_count() const { return static_cast<double>(levels_[0].width) * levels_[0].height; }

 private:
  struct Level {
    int width, height;
    std::vector<float> rgb;
  };
  std::vector<Level> levels_;
};

}  // namespace papilla
