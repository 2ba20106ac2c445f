// SPDX-License-Identifier: MIT
#include "reflectance.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/stored_samples.hpp"
#include "pieces.hpp"

namespace papilla::texture_detail {

void require_shading(const GreyImage& image, const ShadingOptions& options, const char* function) {
  require_image(image, function);
  require_shading_options(options, function);
}

void require_shading_options(const ShadingOptions& options, const char* function) {
  constexpr int k_least_piece = 64;
  if (options.largest_piece_px < k_least_piece)
    throw InvalidInput(std::string(function) + ": pieces of " + std::to_string(options.largest_piece_px) +
                       " pixels are smaller than " + std::to_string(k_least_piece));
  constexpr int k_most_iterations = 100'000;  // tsai-shah keeps 8 bytes a column and step.
  if (options.iterations > k_most_iterations)
    throw InvalidInput(std::string(function) + ": " + std::to_string(options.iterations) +
                       " iterations are more than " + std::to_string(k_most_iterations));
  if (!is_positive(options.albedo) || !is_positive(options.smoothness) || options.iterations < 1 ||
      !is_positive(options.relative_tolerance))
    throw InvalidInput(std::string(function) + ": albedo " + std::to_string(options.albedo) + ", smoothness " +
                       std::to_string(options.smoothness) + ", tolerance " +
                       std::to_string(options.relative_tolerance) + " and iterations " +
                       std::to_string(options.iterations) + " must be positive");
}

ShadingResult in_memory(ShadingByRows method, const GreyImage& image, const ShadingOptions& options) {
  std::vector<double> heights(image.pixels.size());
  ShadingResult result =
      method(SamplesInMemory(image.pixels, image.width, image.height), options, rows_of(heights, image.width));
  remove_mean(heights);
  result.height_px = std::move(heights);
  return result;
}

std::vector<double> brightness(const GreyImage& image, double albedo) {
  std::vector<double> values(image.pixels.size());
  std::transform(image.pixels.begin(), image.pixels.end(), values.begin(),
                 [albedo](float grey) { return brightness(grey, albedo); });
  return values;
}

void remove_mean(std::vector<double>& field) {
  const double mean = std::accumulate(field.begin(), field.end(), 0.0) / static_cast<double>(field.size());
  for (double& value : field) value -= mean;
}

}  // namespace papilla::texture_detail
