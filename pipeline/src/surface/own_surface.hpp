// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "papilla/io/rgba_image.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla {

/// What a material has of its own: its base colour as stored (sRGB) with alpha, roughness and metallic, each its
/// picture times its factor, and the relief that its normal map shows. All are repeated.
class OwnSurface {
 public:
  /// @param mm_per_repeat  of the normal map, positive.
  /// @throws InvalidInput when a picture can't be decoded.
  OwnSurface(const Scene& scene, const Material& material, double mm_per_repeat);
  /// Red, green, blue, alpha; alpha is 1 for a material that is opaque. Bilinear.
  /// @param u, v  in repeats, v down the rows; finite.
  std::array<float, 4> colour_at(double u, double v) const;
  /// Roughness and metallic.
  std::array<float, 2> shine_at(double u, double v) const;
  /// Millimetres, mean 0; 0 without relief.
  float height_at(double u, double v) const;
  /// It has a normal map at the coordinates of its colour, which is the relief.
  bool has_relief() const { return relief_.has_value(); }
  /// It has a metallic-roughness picture on other coordinates, of which only the mean is known.
  bool means_shine() const { return means_shine_; }

 private:
  std::array<float, 4> tint_{};
  std::array<float, 2> shine_{};
  std::optional<RgbaImage> picture_, shine_picture_;
  std::optional<HeightMap> relief_;
  bool is_opaque_ = true, means_shine_ = false;
};

/// The coordinates that a material's pictures lie on: those of its base colour, else of its normal map, else of its
/// metallic-roughness picture; null without.
const TextureReference* own_place(const Material& material);

}  // namespace papilla
