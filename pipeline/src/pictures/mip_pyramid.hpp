// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/io/rgba_image.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// A mip map: a picture at halving resolutions, sampled with bilinear interpolation.
class MipPyramid {
 public:
  struct Texel {
    Vec3 color;
    double alpha = 1;
  };

  /// @param encoded_srgb colours are linearised, so that averages keep the brightness.
  /// @param clamped  beyond its borders across, and down, the picture goes on with its last texel; else it repeats.
  MipPyramid(const RgbaImage& image, bool encoded_srgb, std::array<bool, 2> clamped = {});

  /// The mean colour over about `texels` texels of the full picture (an area), components in [0, 1]; transparent texels
  /// count as far as they are seen. uv (0, 0) is the bottom left corner, v grows upwards, as in scenes.
  Texel sample(Vec2 uv, double texels) const;

  double texel_count() const { return static_cast<double>(levels_[0].width) * levels_[0].height; }
  bool has_alpha() const { return !levels_[0].alpha.empty(); }

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<float> rgb;    ///< Times alpha.
    std::vector<float> alpha;  ///< Empty: all 1.
  };
  static Level halved(const Level& fine);
  std::vector<Level> levels_;
  std::array<bool, 2> clamped_;
};

/// The mip maps of a scene's textures, each made once.
class Pyramids {
 public:
  explicit Pyramids(const Scene& scene) : scene_(scene), color_(scene.textures.size()), raw_(scene.textures.size()) {}

  /// Null where there is no picture that is read. @param color of sRGB. @throws InvalidInput as decode_rgba_image().
  std::shared_ptr<const MipPyramid> get(const std::optional<TextureReference>& reference, bool color);

 private:
  const Scene& scene_;
  std::vector<std::shared_ptr<const MipPyramid>> color_, raw_;
};

}  // namespace papilla
