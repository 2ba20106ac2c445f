// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "papilla/io/scene.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// What a material has of its own: its base colour as stored (sRGB), its picture times its factor, and the relief that
/// its normal map shows. Both are repeated.
class OwnSurface {
 public:
  /// @param mm_per_repeat  of the normal map, positive.
  /// @throws InvalidInput when a picture can't be decoded.
  OwnSurface(const Scene& scene, const Material& material, double mm_per_repeat);
  /// Bilinear. @param u, v  in repeats, v down the rows; finite.
  std::array<float, 3> colour_at(double u, double v) const;
  /// Millimetres, mean 0; 0 without relief.
  float height_at(double u, double v) const;
  /// It has a normal map at the coordinates of its colour, which is the relief.
  bool has_relief() const { return relief_.has_value(); }

 private:
  std::array<float, 3> tint_{};
  std::optional<ColorImage> picture_;
  std::optional<HeightMap> relief_;
};

/// The coordinates that a material's pictures lie on: those of its base colour, else of its normal map; null without.
const TextureReference* own_place(const Material& material);

}  // namespace papilla
