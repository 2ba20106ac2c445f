// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "papilla/core/values.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/io/rgba_image.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// Widths of environment pictures as they are carried: of a scene, and of a single material, whose picture travels in
/// its extras. As RGBE these are 512 KiB and 128 KiB.
inline constexpr int k_scene_environment_width = 512, k_material_environment_width = 256;

/// The light from everywhere, as an equirectangular picture of linear light. Row 0 looks up; in glTF's axes (Y up) the
/// direction d is seen at
///     u = 1/2 + atan2(d.z, d.x) / 2π,   v = 1/2 − asin(d.y) / π,
/// u across and v down, both from 0 to 1: the middle of the picture is seen along +X, as in Blender and three.js.
/// Coded as RGBE, four bytes a pixel: c = mantissa · 2^(exponent − 136), black is 0 [Ward, Real pixels, 1991].
struct EnvironmentPicture {
  int width = 0, height = 0;
  Values<unsigned char> rgbe;  ///< 4 * width * height values.
  friend bool operator==(const EnvironmentPicture&, const EnvironmentPicture&) = default;
};

/// Reads a picture (Radiance HDR, OpenEXR, or one of 8 or 16 bits, taken for sRGB) and reduces it by means over area
/// to `most_width`, when it is wider.
/// @throws IoError, InvalidInput as read_linear_image(); InvalidInput naming the file when it is not twice as wide as
///         high, within 2 %.
EnvironmentPicture read_environment(const std::filesystem::path& path, int most_width);

/// Codes and decodes a picture; decoding gives each value within 1/256 of the pixel's largest one.
EnvironmentPicture encode_environment(const LinearImage& image);
LinearImage decode_environment(const EnvironmentPicture& picture);

/// What a material's extras hold as papilla.environment: {"projection": "equirectangular", "encoding": "rgbe", "uri":
/// a data: URI of a PNG}.
std::string environment_json(const EnvironmentPicture& picture);

/// The environment in a material's extras; nothing where there is none.
/// @throws InvalidInput naming the material when its picture is damaged.
std::optional<EnvironmentPicture> environment_of(const Material& material);

/// An environment made ready to light surfaces.
class EnvironmentLight {
 public:
  explicit EnvironmentLight(const EnvironmentPicture& picture);

  /// Radiance of a white matt surface with this unit normal: ∫ L(d) max(0, n·d) dd / π, by spherical harmonics up to
  /// second order, which hold it within a few per cent [Ramamoorthi and Hanrahan, An efficient representation for
  /// irradiance environment maps, 2001]. At least 0.
  Vec3 diffuse(Vec3 normal) const noexcept;

  /// Radiance around the direction: of a mirror for roughness 0, else the mean over about the lobe's width,
  /// roughness² radians.
  Vec3 reflection(Vec3 direction, double roughness) const noexcept;

 private:
  Vec3 texel(const LinearImage& level, int x, int y) const noexcept;
  std::vector<LinearImage> levels_;  ///< Halving.
  std::array<Vec3, 9> harmonics_{};
};

}  // namespace papilla
