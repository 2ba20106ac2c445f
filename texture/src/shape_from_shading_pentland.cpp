// SPDX-License-Identifier: MIT
#include <algorithm>

#include "checks.hpp"
#include "linear_shading.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "reflectance.hpp"

namespace papilla {
namespace {

constexpr const char* k_name = "shape_from_shading_pentland";
constexpr double k_damping = 0.1;

double damping(double, double) { return k_damping * k_damping; }

Vec3 light_of(const ShadingOptions& options) {
  return texture_detail::oblique(texture_detail::require_light(options.light, k_name));
}

}  // namespace

ShadingResult shape_from_shading_pentland(const GreyImage& image, const ShadingOptions& options) {
  texture_detail::require_shading(image, options, k_name);
  if (std::max(image.width, image.height) > options.largest_piece_px)
    return texture_detail::in_memory(shape_from_shading_pentland_by_rows, image, options);
  return texture_detail::linear_shading(image, options, light_of(options), damping);
}

ShadingResult shape_from_shading_pentland_by_rows(const SampleRows& picture, const ShadingOptions& options,
                                                  const HeightWriter& write) {
  texture_detail::require_shading_options(options, k_name);
  return texture_detail::linear_shading_by_rows(picture, options, light_of(options), damping, write);
}

}  // namespace papilla
