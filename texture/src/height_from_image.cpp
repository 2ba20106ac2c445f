// SPDX-License-Identifier: MIT
#include "papilla/texture/height_from_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/light_direction.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "papilla/texture/symmetry.hpp"
#include "papilla/texture/tiling.hpp"

namespace papilla {
namespace {

constexpr std::array<std::pair<HeightMethod, std::string_view>, 4> k_names = {
    {{HeightMethod::automatic, "auto"},
     {HeightMethod::variational, "variational"},
     {HeightMethod::tsai_shah, "tsai-shah"},
     {HeightMethod::intensity, "intensity"}}};

void require_options(const HeightOptions& options) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (!positive(options.depth_mm))
    throw InvalidInput("height_from_image: depth " + std::to_string(options.depth_mm) + " mm is not positive");
  if (options.pitch_mm != 0 && !positive(options.pitch_mm))
    throw InvalidInput("height_from_image: pitch " + std::to_string(options.pitch_mm) + " mm is not positive");
  if (options.albedo != 0 && !positive(options.albedo))
    throw InvalidInput("height_from_image: albedo " + std::to_string(options.albedo) + " is not positive");
  if (options.iterations < 0)
    throw InvalidInput("height_from_image: iterations " + std::to_string(options.iterations) + " is negative");
}

void choose_method(const GreyImage& image, const HeightOptions& options, HeightResult& result) {
  if (options.method != HeightMethod::automatic) {
    result.method = options.method;
    result.reason = "asked for";
    return;
  }
  const Lattice lattice = analyze_symmetry(image).lattice;
  result.method = lattice.found ? HeightMethod::variational : HeightMethod::intensity;
  result.reason = lattice.found ? "the picture repeats: lit elements" : "grey read as height: " + lattice.reason;
}

void choose_light(const GreyImage& image, const HeightOptions& options, HeightResult& result) {
  if (options.light) {
    result.light = texture_detail::require_light(*options.light, "height_from_image");
    return;
  }
  const LightEstimate estimate = estimate_light(image);
  result.light = estimate.direction;
  result.light_estimated = true;
  result.light_coherence = estimate.coherence;
}

std::vector<double> height_by_shading(const GreyImage& image, const HeightOptions& options, HeightResult& result) {
  choose_light(image, options, result);
  const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  const double mean =
      std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0) / static_cast<double>(image.pixels.size());
  if (!(*low < *high) || !(mean > 0)) {
    result.stop = StopReason::direct;
    return std::vector<double>(image.pixels.size(), 0.0);
  }
  ShadingOptions shading;
  shading.light = result.light;
  shading.albedo = options.albedo > 0 ? options.albedo : mean / result.light.z;
  shading.periodic = result.map.periodic;
  if (options.iterations > 0) shading.iterations = options.iterations;
  shading.progress = options.progress;
  ShadingResult solved = result.method == HeightMethod::variational ? shape_from_shading_variational(image, shading)
                                                                    : shape_from_shading_tsai_shah(image, shading);
  result.trace = std::move(solved.trace);
  result.stop = solved.stop;
  return std::move(solved.height_px);
}

/// Fills the map with heights stretched to 0…depth.
void scale_to_depth(const std::vector<double>& heights, double depth_mm, HeightResult& result) {
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double offset = *low, range = *high - *low;
  const double scale = range > 0 ? depth_mm / range : 0;
  result.map.mm.resize(heights.size());
  std::transform(heights.begin(), heights.end(), result.map.mm.begin(),
                 [&](double height) { return static_cast<float>(scale * (height - offset)); });
  result.depth_mm = range > 0 ? depth_mm : 0;
}

}  // namespace

std::string_view to_string(HeightMethod method) noexcept {
  for (const auto& [value, name] : k_names)
    if (value == method) return name;
  return "unknown";
}

HeightMethod height_method(std::string_view name) {
  for (const auto& [value, known] : k_names)
    if (known == name) return value;
  throw InvalidInput("height_method: '" + std::string(name) + "' is not auto, variational, tsai-shah or intensity");
}

HeightResult height_from_image(const GreyImage& image, const HeightOptions& options) {
  texture_detail::require_image(image, "height_from_image");
  require_options(options);
  HeightResult result;
  const double pitch = options.pitch_mm > 0 ? options.pitch_mm : std::max(0.0, image.pitch_mm);
  result.map.width = image.width;
  result.map.height = image.height;
  result.map.pitch_mm_x = result.map.pitch_mm_y = pitch;
  result.map.periodic = options.periodic ? *options.periodic : measure_tiling(image).tiles;
  choose_method(image, options, result);
  if (result.method == HeightMethod::intensity)
    scale_to_depth({image.pixels.begin(), image.pixels.end()}, options.depth_mm, result);
  else
    scale_to_depth(height_by_shading(image, options, result), options.depth_mm, result);
  result.rms_mm = rms_height_mm(result.map);
  return result;
}

}  // namespace papilla
