// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/shape_from_shading.hpp"

namespace papilla::texture_detail {

/// max(0, R(p, q)) of ShadingOptions and its derivatives.
struct Reflectance {
  double value, dp, dq;
};

inline Reflectance reflectance(Vec3 s, double p, double q) {
  const double inverse = 1 / std::sqrt(1 + p * p + q * q);
  const double r = (s.z - s.x * p - s.y * q) * inverse;
  if (r <= 0) return {0, 0, 0};
  return {r, -s.x * inverse - r * p * inverse * inverse, -s.y * inverse - r * q * inverse * inverse};
}

/// Light closer to the viewer than this leaves a flat start flat: the derivative of the brightness vanishes there.
inline constexpr double k_least_obliqueness = 0.01;

/// The light with length 1, moved off the viewing direction as Tsai and Shah do.
inline Vec3 oblique(Vec3 light) {
  if (std::hypot(light.x, light.y) >= k_least_obliqueness) return light;
  return normalized({k_least_obliqueness, k_least_obliqueness, 1});
}

/// @throws InvalidInput naming `function` when the picture or an option is out of range.
void require_shading(const GreyImage& image, const ShadingOptions& options, const char* function);

/// The same of the options alone.
void require_shading_options(const ShadingOptions& options, const char* function);

using ShadingByRows = ShadingResult (*)(const SampleRows&, const ShadingOptions&, const HeightWriter&);

/// A method that solves by pieces, on a picture in memory.
ShadingResult in_memory(ShadingByRows method, const GreyImage& image, const ShadingOptions& options);

/// The grey value over the albedo, bounded so that squares and their sums are finite.
inline double brightness(float grey, double albedo) {
  constexpr double k_most = 1e100;
  return std::clamp(static_cast<double>(grey) / albedo, -k_most, k_most);
}

/// The picture over the albedo.
std::vector<double> brightness(const GreyImage& image, double albedo);

void remove_mean(std::vector<double>& field);

}  // namespace papilla::texture_detail
